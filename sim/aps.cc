#include "sim/aps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace nightjar::sim {
namespace {

constexpr double kNeededLuxS = 5;
constexpr double kLongestExposureS = 0.5;

constexpr int kAdcBits = 10;
constexpr int kAdcCodes = 1 << kAdcBits;
constexpr int kAdcCodesPerByte = kAdcCodes / 256;

// NaN and negative light is none; infinite light saturates without spoiling sums.
float usable(float luminance_lux) {
  constexpr float kMost = 1e12f;
  return luminance_lux > 0 ? std::min(luminance_lux, kMost) : 0.0f;
}

bool is_bad(float luminance_lux) {
  return !(luminance_lux >= 0 && luminance_lux < std::numeric_limits<float>::infinity());
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
  last_lux_.assign(size.pixels(), 0.0f);
  next_lux_ = charge_lux_s_ = last_lux_;

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
  take(luminance_lux);
  std::optional<core::ApsFrame> frame;
  if (!last_) {
    begin_ = t;
  } else {
    integrate(t);
    if (t >= begin_ + exposure_) {
      frame = read();
      begin_ += interval_;
      integrate(t);  // the next exposure may have begun within this step
    }
  }
  std::swap(last_lux_, next_lux_);
  last_ = t;
  return frame;
}

void ApsSensor::take(const core::Image<float>& luminance_lux) {
  const auto pixels = luminance_lux.pixels();
  std::ranges::transform(pixels, next_lux_.begin(), usable);
  int bad = 0;
  for (const float lux : pixels) bad += is_bad(lux);
  bad_radiance_ += static_cast<std::uint64_t>(bad);
}

void ApsSensor::integrate(core::Time t) {
  const core::Time from = std::max(*last_, begin_);
  const core::Time to = std::min(t, begin_ + exposure_);
  if (from >= to) return;
  // Mean of a straight line: its value in the middle of what falls into the exposure.
  const double middle = core::seconds((from - *last_) + (to - *last_)) / 2;
  const double share = middle / core::seconds(t - *last_);
  const auto now = static_cast<float>(share * core::seconds(to - from));
  const auto before = static_cast<float>((1 - share) * core::seconds(to - from));
  for (std::size_t p = 0; p < charge_lux_s_.size(); ++p)
    charge_lux_s_[p] += before * last_lux_[p] + now * next_lux_[p];
}

core::ApsFrame ApsSensor::read() {
  core::ApsFrame frame{begin_, begin_ + exposure_, static_cast<int>(config_.bits),
                       core::Image<std::uint16_t>(size_)};
  const int dropped_bits = kAdcBits - frame.bits;
  const double black = config_.black_level * kAdcCodesPerByte;
  const double codes_per_e = (kAdcCodes - 1 - black) / config_.full_well_e;
  const double read_variance = config_.read_noise_e * config_.read_noise_e;
  const auto gray = frame.gray.pixels();
  std::array<double, 2> noise{};
  for (std::size_t p = 0; p < gray.size(); ++p) {
    if (p % 2 == 0) noise = core::normal_pair(noise_);
    // Photons are counted by the hundreds here, where Poisson is all but Gaussian.
    const double photo_e = static_cast<double>(charge_lux_s_[p]) * gain_[p];
    const double noise_e = std::sqrt(photo_e + read_variance) * noise[p % 2];
    const double stored_e = std::min(photo_e + noise_e + offset_e_[p], config_.full_well_e);
    const double code = std::clamp(black + codes_per_e * stored_e, 0.0, kAdcCodes - 1.0);
    gray[p] = static_cast<std::uint16_t>(static_cast<int>(code + 0.5) >> dropped_bits);
  }
  std::ranges::fill(charge_lux_s_, 0.0f);
  return frame;
}

}  // namespace nightjar::sim
