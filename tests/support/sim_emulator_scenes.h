#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/image.h"
#include "sim/emulator.h"

/// Scenes for the event emulator, and what runs it over them.
namespace nightjar::test {

inline constexpr double kWhite_lux = 5.0;

/// Luminance of a pixel (lux) at a time (s).
using Scene = std::function<double(int x, int y, double t_s)>;

inline core::Image<float> picture(core::Resolution size, const Scene& scene, double t_s) {
  core::Image<float> image(size);
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x) image(x, y) = static_cast<float>(scene(x, y, t_s));
  return image;
}

/// Steps of `dt` from 0 to `end`; the events of all.
inline std::vector<core::Event> run(sim::EventEmulator& emulator, core::Resolution size,
                                    const Scene& scene, core::Time end, core::Time dt) {
  std::vector<core::Event> events;
  for (core::Time t{}; t <= end; t += dt)
    emulator.step(t, picture(size, scene, core::seconds(t)), events);
  return events;
}

/// No noise, no mismatch, no low pass.
inline sim::PixelConfig ideal() {
  sim::PixelConfig config = sim::preset_pixel(sim::SensorPreset::clean, 5);
  config.threshold_on_sigma_log = config.threshold_off_sigma_log = 0;
  return config;
}

inline sim::PixelConfig only_low_pass(double cutoff_hz) {
  sim::PixelConfig config = ideal();
  config.cutoff_hz = cutoff_hz;
  return config;
}

inline Scene still(double luminance_lux) {
  return [luminance_lux](int, int, double) { return luminance_lux; };
}

/// Log intensity moves by 2.5 up and down; each pixel a little differently.
inline double sine(int x, int y, double t_s) {
  return std::exp(0.2 + 1.2 * std::sin(2 * std::numbers::pi * (3 * t_s + 0.03 * x + 0.1 * y)));
}
inline double ramp(int x, int y, double t_s) { return 0.5 + (0.4 + 0.02 * x + 0.1 * y) * 5 * t_s; }
inline double jump(int x, int, double t_s) { return t_s < 0.1 + 0.001 * x ? 0.3 : 4.0; }
inline double edge(int x, int y, double t_s) {
  // A slanted edge, 2 px wide, that crosses the picture.
  const double distance_px = x + 0.3 * y - 100 * t_s + 5;
  return 2.2 - 1.8 * std::tanh(distance_px);
}

}  // namespace nightjar::test
