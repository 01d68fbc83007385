#include "sim/aps.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace nightjar::sim {
namespace {

constexpr double kNeededLuxS = 5;
constexpr double kLongestExposureS = 0.5;

constexpr int kAdcBits = 10;
constexpr int kAdcCodes = 1 << kAdcBits;
constexpr int kAdcCodesPerByte = kAdcCodes / 256;

ApsConversion conversion(const ApsConfig& config) {
  const double black_codes = config.black_level * kAdcCodesPerByte;
  return {.read_variance_e2 = static_cast<float>(config.read_noise_e * config.read_noise_e),
          .full_well_e = static_cast<float>(config.full_well_e),
          .codes_per_e = static_cast<float>((kAdcCodes - 1 - black_codes) / config.full_well_e),
          .black_codes = static_cast<float>(black_codes),
          .most_codes = kAdcCodes - 1,
          .dropped_bits = kAdcBits - static_cast<int>(config.bits)};
}

/// What a step's pictures count for in an exposure, in s.
struct Weights {
  float before_s = 0, now_s = 0;
};

/// Of the step from `last` to `t` what falls into [begin, end).
Weights weights(core::Time last, core::Time t, core::Time begin, core::Time end) {
  const core::Time from = std::max(last, begin), to = std::min(t, end);
  if (from >= to) return {};
  // Mean of a straight line: its value in the middle of what falls into the exposure.
  const double middle = core::seconds((from - last) + (to - last)) / 2;
  const double share = middle / core::seconds(t - last);
  return {.before_s = static_cast<float>((1 - share) * core::seconds(to - from)),
          .now_s = static_cast<float>(share * core::seconds(to - from))};
}

}  // namespace

core::Time aps_exposure(const ApsConfig& config, double illuminance_lux) {
  if (config.exposure_ms > 0)
    return std::max(core::Time(1), core::from_seconds(config.exposure_ms * 1e-3));
  const double needed_s = std::min(kLongestExposureS, kNeededLuxS / illuminance_lux);
  return std::max(core::Time(1), core::from_seconds(needed_s));
}

ApsSensor::ApsSensor(const ApsConfig& config, core::Resolution size, double illuminance_lux,
                     std::uint64_t seed)
    : config_(config), noise_(core::random_stream(seed, "aps")), size_(size) {
  core::check_config(config, "aps");
  core::check_range("size.width_px", size.width_px, 1, 65535);
  core::check_range("size.height_px", size.height_px, 1, 65535);
  core::check_range("illuminance_lux", illuminance_lux, 1e-6, 1e9);
  exposure_ = aps_exposure(config, illuminance_lux);
  interval_ = std::max(exposure_, core::from_seconds(config.interval_ms * 1e-3));
  conversion_ = conversion(config);
  last_lux_.assign(size.pixels(), 0.0f);
  charge_lux_s_ = last_lux_;

  core::Random gain = core::random_stream(seed, "aps_gain");
  core::Random offset = core::random_stream(seed, "aps_offset");
  for (int p = 0; p < size.pixels(); ++p) {
    const double relative = std::max(0.0, 1 + config.gain_fpn * core::normal(gain));
    gain_.push_back(static_cast<float>(config.electrons_per_lux_s * relative));
    offset_e_.push_back(static_cast<float>(config.offset_fpn_e * core::normal(offset)));
  }
}

void ApsSensor::check(core::Time t, const core::Image<float>& luminance_lux) const {
  if (luminance_lux.size() != size_)
    throw std::invalid_argument(fmt::format("luminance of {}x{} px, expected {}x{}",
                                            luminance_lux.width(), luminance_lux.height(),
                                            size_.width_px, size_.height_px));
  if (last_ && (t <= *last_ || t - *last_ > interval_))
    throw std::invalid_argument(fmt::format("time = {} us, allowed above {} and at most {} later",
                                            t.count(), last_->count(), interval_.count()));
}

std::optional<core::ApsFrame> ApsSensor::add(core::Time t,
                                             const core::Image<float>& luminance_lux) {
  check(t, luminance_lux);
  std::optional<core::ApsFrame> frame;
  if (!last_) {
    begin_ = t;
  } else if (t >= begin_ + exposure_) {
    expose(t, luminance_lux);
    frame = read();
    begin_ += interval_;  // and the next exposure may have begun within this step
  }
  expose_and_keep(t, luminance_lux);
  return frame;
}

void ApsSensor::expose(core::Time t, const core::Image<float>& luminance_lux) {
  const Weights w = weights(*last_, t, begin_, begin_ + exposure_);
  const auto lux = luminance_lux.pixels();
  best_aps_variant().integrate(last_lux_.data(), w.before_s, lux.data(), w.now_s,
                               static_cast<std::uint32_t>(lux.size()), charge_lux_s_.data());
}

void ApsSensor::expose_and_keep(core::Time t, const core::Image<float>& luminance_lux) {
  constexpr std::size_t kChunk = 2048;  // what is read twice is still in the nearest cache
  const Weights w = last_ ? weights(*last_, t, begin_, begin_ + exposure_) : Weights{};
  const ApsVariant& kernel = best_aps_variant();
  const auto lux = luminance_lux.pixels();
  for (std::size_t p = 0; p < lux.size(); p += kChunk) {
    const auto count = static_cast<std::uint32_t>(std::min(kChunk, lux.size() - p));
    if (w.before_s > 0 || w.now_s > 0)
      kernel.integrate(&last_lux_[p], w.before_s, &lux[p], w.now_s, count, &charge_lux_s_[p]);
    bad_radiance_ += kernel.take(&lux[p], count, &last_lux_[p]);
  }
  last_ = t;
}

core::ApsFrame ApsSensor::read() {
  core::ApsFrame frame{begin_, begin_ + exposure_, static_cast<int>(config_.bits),
                       core::Image<std::uint16_t>(size_)};
  const auto gray = frame.gray.pixels();
  ApsDraws draws;
  for (std::size_t p = 0; p < gray.size(); p += kApsBatch) {
    for (std::uint32_t i = 0; i < kApsBatch / 2; ++i) {
      const std::uint64_t bits = noise_();
      draws.high[i] = static_cast<std::uint32_t>(bits >> 32);
      draws.low[i] = static_cast<std::uint32_t>(bits);
    }
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kApsBatch, gray.size() - p));
    best_aps_variant().read(conversion_, draws, &gain_[p], &offset_e_[p], count, &charge_lux_s_[p],
                            &gray[p]);
  }
  return frame;
}

}  // namespace nightjar::sim
