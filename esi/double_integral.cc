#include "esi/double_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "esi/best_instructions.h"
#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

/// `t` minus `now`, but no further off than 17.9 minutes.
std::int64_t near_us(core::Time t, core::Time now) {
  constexpr auto kMost = static_cast<double>(Reconstructor::kMostAge_us);
  const double difference = static_cast<double>(t.count()) - static_cast<double>(now.count());
  return static_cast<std::int64_t>(std::clamp(difference, -kMost, kMost));
}

/// log2 of B for each value that a pixel of so many bits can have.
std::array<float, 1024> log_brightness(int bits) {
  std::array<float, 1024> log2;
  const int white = (1 << bits) - 1;
  for (int value = 0; value <= white; ++value)
    log2[static_cast<std::size_t>(value)] =
        static_cast<float>(std::log2(std::max(1.0 * value, 0.5) / white));
  return log2;
}

const DoubleIntegralConfig& checked(const DoubleIntegralConfig& config, const std::string& path) {
  core::check_config(config, path);
  core::check_range(path + ".search_greatest_log", config.search_greatest_log,
                    config.search_least_log, 2.0);
  return config;
}

}  // namespace

void Growth::tabulate(double contrast_log, int least, int greatest) {
  least_ = least;
  table_.resize(static_cast<std::size_t>(greatest - least) + 1);
  for (int n = least; n <= greatest; ++n)
    table_[static_cast<std::size_t>(n - least)] =
        std::exp(std::clamp(contrast_log * n, -350.0, 350.0));
}

DoubleIntegral::DoubleIntegral(const DoubleIntegralConfig& config, core::Resolution size,
                               const char* path)
    : Reconstructor(size),
      config_(checked(config, path)),
      history_(static_cast<std::uint32_t>(config.history_s * 1e6), kMostKept),
      start_log2_(static_cast<std::size_t>(size.pixels())),
      count_(start_log2_.size()),
      count_to_middle_(start_log2_.size()),
      still_(size),
      latent_(size),
      log_mean_(size) {}

void DoubleIntegral::clear(core::Time) {
  history_.clear();
  contrast_log_ = config_.contrast_log;
  std::ranges::fill(start_log2_, -1.0f);
  std::ranges::fill(count_, 0.0f);
}

void DoubleIntegral::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  history_.drop_older(now_us, most_us);
}

void DoubleIntegral::integrate(std::span<const PackedEvent> events) {
  constexpr float kStep[] = {-1, 1};
  for (const PackedEvent& e : events) count_[e.pixel()] += kStep[e.pixel_on & 1u];
  history_.append(events);
}

/// Forgets the events before it, too: no later frame begins earlier.
DoubleIntegral::Exposure DoubleIntegral::find_exposure(const core::ApsFrame& frame) {
  const std::int64_t begin = near_us(frame.exposure_begin, last());
  const std::int64_t end = std::max(near_us(frame.exposure_end, last()), begin + 1);
  const std::uint32_t now_us = low_us(last());
  const auto is_before = [&](std::int64_t time) {
    return [=](const PackedEvent& e) { return -std::int64_t{now_us - e.t_us} < time; };
  };
  const auto all = history_.events();
  history_.drop_first(
      static_cast<std::size_t>(std::ranges::partition_point(all, is_before(begin)) - all.begin()));
  const auto kept = history_.events();
  const auto exposed = std::ranges::partition_point(kept, is_before(end)) - kept.begin();
  return {kept.first(static_cast<std::size_t>(exposed)), now_us + static_cast<std::uint32_t>(begin),
          now_us + static_cast<std::uint32_t>(end)};
}

void DoubleIntegral::count_events(const Exposure& exposure) {
  std::ranges::fill(count_, 0.0f);
  std::ranges::fill(still_.pixels(), 1.0f);
  float least = 0, greatest = 0;
  float* still = still_.pixels().data();
  const auto count = [&](std::span<const PackedEvent> events) {
    for (const PackedEvent& e : events) {
      const float level = count_[e.pixel()] += e.on() ? 1.0f : -1.0f;
      least = std::min(least, level);
      greatest = std::max(greatest, level);
      still[e.pixel()] = 0;
    }
  };
  const std::uint32_t half_us = (exposure.end_us - exposure.begin_us) / 2;
  const auto middle = std::ranges::partition_point(
      exposure.events, [&](const PackedEvent& e) { return e.t_us - exposure.begin_us < half_us; });
  const auto first = static_cast<std::size_t>(middle - exposure.events.begin());
  count(exposure.events.first(first));
  std::ranges::copy(count_, count_to_middle_.begin());
  count(exposure.events.subspan(first));
  least_level_ = Growth::level(static_cast<int>(least));
  greatest_level_ = Growth::level(static_cast<int>(greatest));
  for (const PackedEvent& e : history_.events().subspan(exposure.events.size()))
    count_[e.pixel()] += e.on() ? 1.0f : -1.0f;
}

double DoubleIntegral::sharpness_at(double contrast_log) {
  constexpr float kLeast = -6;  // times white: noise below it is no edge
  const SharpnessRows rows = SharpnessRows::of(size().height_px);
  growth_.tabulate(contrast_log, least_level_, greatest_level_);
  log_means(growth_, rows, log_mean_);
  const float step_log2 = static_cast<float>(contrast_log) * kLog2E;
  for (int y = 0; y < size().height_px; ++y) {
    if (!rows.takes(y)) continue;
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size().width_px);
    const float* brightness = start_log2_.data() + row;
    const float* count = count_to_middle_.data() + row;
    const float* log_mean = &log_mean_(0, y);
    float* latent = &latent_(0, y);
#pragma GCC ivdep
    for (int x = 0; x < size().width_px; ++x)
      latent[x] = bounded(brightness[x] - log_mean[x] + step_log2 * count[x], kLeast, 0.0f);
  }
  return sharpness(latent_, still_, rows);
}

void DoubleIntegral::take_frame(core::ApsFrame&& frame) {
  const Exposure exposure = find_exposure(frame);
  count_events(exposure);
  const auto log2 = log_brightness(frame.bits);
  std::ranges::transform(frame.gray.pixels(), start_log2_.begin(),
                         [&](std::uint16_t value) { return log2[value]; });
  if (exposure.events.empty()) return;
  std::ranges::fill(log_mean_.pixels(), 0.0f);
  expose(exposure);
  if (config_.search_contrast)
    contrast_log_ =
        first_maximum(config_.search_least_log, config_.search_greatest_log, [this](double c) {
          return sharpness_at(c);
        }).value_or(contrast_log_);
  growth_.tabulate(contrast_log_, least_level_, greatest_level_);
  log_means(growth_, SharpnessRows{1}, log_mean_);
  std::ranges::transform(start_log2_, log_mean_.pixels(), start_log2_.begin(), std::minus<>());
}

void DoubleIntegral::draw(core::Time, core::Image<std::uint8_t>& gray) {
  const float step_log2 = static_cast<float>(contrast_log_) * kLog2E;
  const float* start = start_log2_.data();
  const float* count = count_.data();
  std::uint8_t* out = gray.pixels().data();
  const std::size_t pixels = start_log2_.size();
  with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < pixels; ++i)
      out[i] = to_gray(255.0f * fast_exp2(start[i] + step_log2 * count[i]));
  });
}

}  // namespace nightjar::esi
