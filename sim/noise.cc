#include "sim/noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

constexpr double kLeastThreshold = 0.01;  // v2e emulator.py, cac6384

}  // namespace

PointProcess::PointProcess(std::span<const double> rates_hz, core::Random random)
    : columns_(rates_hz.size()), random_(random) {
  const double total_hz = std::accumulate(rates_hz.begin(), rates_hz.end(), 0.0);
  if (!(total_hz > 0)) return;
  mean_gap_us_ = 1e6 / total_hz;

  // Vose's construction: each column below the mean is filled up by one above it.
  std::vector<double> height(rates_hz.begin(), rates_hz.end());
  const double mean_hz = total_hz / static_cast<double>(height.size());
  std::vector<std::uint32_t> below, above;
  for (std::uint32_t i = 0; i < height.size(); ++i) {
    height[i] /= mean_hz;
    columns_[i] = {UINT32_MAX, i};
    (height[i] < 1 ? below : above).push_back(i);
  }
  while (!below.empty() && !above.empty()) {
    const std::uint32_t low = below.back();
    const std::uint32_t high = above.back();
    below.pop_back();
    columns_[low] = {static_cast<std::uint32_t>(height[low] * 0x1p32), high};
    height[high] -= 1 - height[low];
    if (height[high] >= 1) continue;
    above.pop_back();
    below.push_back(high);
  }
}

void PointProcess::start(core::Time t) {
  last_us_ = static_cast<double>(t.count());
  if (mean_gap_us_ > 0) draw_ahead();
}

void PointProcess::draw(core::Time until, std::vector<NoisePoint>& points) {
  if (!(mean_gap_us_ > 0)) return;
  const double until_us = static_cast<double>(until.count());
  for (; ahead_[next_].t_us <= until_us; ++next_ == kAhead ? draw_ahead() : void())
    points.push_back(ahead_[next_]);
}

void PointProcess::draw_ahead() {
  std::array<std::uint32_t, kAhead> column, height;
  for (std::uint32_t k = 0; k < kAhead; ++k) {
    const std::uint64_t bits = random_();
    column[k] = static_cast<std::uint32_t>(((bits >> 32) * columns_.size()) >> 32);
    height[k] = static_cast<std::uint32_t>(bits);
    __builtin_prefetch(&columns_[column[k]]);
  }
  std::array<float, kAhead> gap;
  for (std::uint32_t k = 0; k < kAhead; ++k) {
    // 40 bits for the gap, so that none is beyond reach, 24 for the mark.
    const std::uint64_t bits = random_();
    gap[k] = static_cast<float>(static_cast<std::int64_t>(bits >> 24) + 1) * 0x1p-40f;
    ahead_[k].mark = static_cast<float>(static_cast<std::int32_t>(bits & 0xffffff)) * 0x1p-24f;
  }
  for (float& g : gap) g = -fast_log<Apart>(g);  // many at a time
  for (std::uint32_t k = 0; k < kAhead; ++k) {
    last_us_ += mean_gap_us_ * static_cast<double>(gap[k]);
    ahead_[k].t_us = last_us_;
  }
  for (std::uint32_t k = 0; k < kAhead; ++k) {
    const Column& c = columns_[column[k]];
    ahead_[k].source = height[k] <= c.share ? column[k] : c.alias;
  }
  next_ = 0;
}

std::vector<double> shot_noise_rates_hz(double shot_noise_rate_hz, double threshold_log,
                                        std::span<const float> thresholds_log) {
  std::vector<double> rates_hz;
  rates_hz.reserve(thresholds_log.size());
  for (const float own_log : thresholds_log)
    rates_hz.push_back(shot_noise_rate_hz / 2 * threshold_log / own_log);
  return rates_hz;
}

HotPixels draw_hot_pixels(const PixelConfig& config, std::uint32_t pixels, std::uint64_t seed) {
  core::Random choice = core::random_stream(seed, "hot_pixel");
  core::Random rate = core::random_stream(seed, "hot_pixel_rate");
  HotPixels hot;
  for (std::uint32_t p = 0; p < pixels; ++p) {
    const double deviation = core::normal(rate);
    if (core::uniform01(choice) >= config.hot_pixel_fraction) continue;
    hot.pixels.push_back(p);
    hot.rates_hz.push_back(config.hot_pixel_rate_median_hz *
                           std::exp(config.hot_pixel_rate_sigma_ln * deviation));
  }
  return hot;
}

std::vector<float> draw_thresholds_log(double mean_log, double sigma_log, std::size_t pixels,
                                       core::Random random) {
  std::vector<float> thresholds(pixels);
  for (float& threshold : thresholds)
    threshold =
        static_cast<float>(std::max(kLeastThreshold, mean_log + sigma_log * core::normal(random)));
  return thresholds;
}

}  // namespace nightjar::sim
