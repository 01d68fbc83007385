#include "sim/sensor_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace nightjar::sim {
namespace {

constexpr double kDarkLux = 0.1;
constexpr double kDimLux = 5.0;
constexpr double kBrightLux = 1000.0;

// v2e's clean preset.
PixelConfig clean_pixel() {
  PixelConfig pixel;
  pixel.threshold_on_sigma_log = pixel.threshold_off_sigma_log = 0.02;
  pixel.cutoff_hz = 0;
  pixel.leak_rate_hz = 0;
  pixel.shot_noise_rate_hz = 0;
  pixel.hot_pixel_fraction = 0;
  return pixel;
}

// v2e's noisy preset: PixelConfig's defaults.
PixelConfig dim_pixel() { return {}; }

// The defaults of v2e's command line.
PixelConfig bright_pixel() {
  PixelConfig pixel;
  pixel.threshold_on_sigma_log = pixel.threshold_off_sigma_log = 0.03;
  pixel.cutoff_hz = 300;
  pixel.refractory_us = 500;
  pixel.leak_rate_hz = 0.01;
  pixel.shot_noise_rate_hz = 0.001;
  return pixel;
}

// Lower end of by_illuminance: the cutoff is proportional to the light; IEBCS's
// measured noise at 0.1 lux has a median of 10 Hz ON and 7 Hz OFF.
PixelConfig dark_pixel() {
  PixelConfig pixel = dim_pixel();
  pixel.cutoff_hz *= kDarkLux / kDimLux;
  pixel.shot_noise_rate_hz = 17;
  return pixel;
}

/// `fraction` of the way from `a` to `b`, straight in the logarithm of each value;
/// straight in the value where an end is 0.
double between(double a, double b, double fraction) {
  if (a > 0 && b > 0) return a * std::pow(b / a, fraction);
  return a + (b - a) * fraction;
}

PixelConfig between(const PixelConfig& a, const PixelConfig& b, double fraction) {
  PixelConfig pixel = a;
  for (double PixelConfig::*member :
       {&PixelConfig::threshold_on_sigma_log, &PixelConfig::threshold_off_sigma_log,
        &PixelConfig::cutoff_hz, &PixelConfig::refractory_us, &PixelConfig::leak_rate_hz,
        &PixelConfig::shot_noise_rate_hz})
    pixel.*member = between(a.*member, b.*member, fraction);
  return pixel;
}

PixelConfig interpolated_pixel(double lux) {
  const double at_lux = std::clamp(lux, kDarkLux, kBrightLux);
  const auto fraction = [at_lux](double from, double to) {
    return std::log(at_lux / from) / std::log(to / from);
  };
  if (at_lux <= kDimLux) return between(dim_pixel(), dark_pixel(), fraction(kDimLux, kDarkLux));
  return between(dim_pixel(), bright_pixel(), fraction(kDimLux, kBrightLux));
}

}  // namespace

PixelConfig preset_pixel(SensorPreset preset, double illuminance_lux) {
  if (!(illuminance_lux > 0))
    throw std::invalid_argument(
        fmt::format("illuminance_lux = {}, allowed above 0", illuminance_lux));
  switch (preset) {
    case SensorPreset::by_illuminance: return interpolated_pixel(illuminance_lux);
    case SensorPreset::clean: return clean_pixel();
    case SensorPreset::bright: return bright_pixel();
    case SensorPreset::dim: return dim_pixel();
    case SensorPreset::custom: break;
  }
  throw std::invalid_argument("preset = custom has no pixels of its own");
}

PixelConfig effective_pixel(const SensorConfig& config, double illuminance_lux) {
  if (config.preset == SensorPreset::custom) return config.pixel;
  return preset_pixel(config.preset, illuminance_lux);
}

}  // namespace nightjar::sim
