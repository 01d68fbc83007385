#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/random.h"
#include "sim/noise.h"
#include "sim/sensor_config.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::test {

/// The emulator with every effect as one would write it down: pixel by pixel, in double
/// precision, with the C library's functions, no refractory period. Its random draws are
/// its own, so that it agrees with the fast one in numbers and not event by event.
class ScalarEmulator {
 public:
  ScalarEmulator(const sim::PixelConfig& config, core::Resolution size, double white_lux,
                 std::uint64_t seed)
      : config_(config),
        size_(size),
        white_lux_(white_lux),
        pixels_(size.pixels()),
        random_(core::random_stream(seed, "scalar_emulator")) {
    const auto on = sim::draw_thresholds_log(config.threshold_on_log, config.threshold_on_sigma_log,
                                             pixels_.size(), random_);
    const auto off = sim::draw_thresholds_log(
        config.threshold_off_log, config.threshold_off_sigma_log, pixels_.size(), random_);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      pixels_[p].on = on[p];
      pixels_[p].off = off[p];
      pixels_[p].mean_leak_per_s =
          config.leak_rate_hz * on[p] *
          std::pow(10.0, config.leak_spread_decades * core::normal(random_));
      pixels_[p].leak_per_s = pixels_[p].mean_leak_per_s;
    }
    const sim::HotPixels hot =
        sim::draw_hot_pixels(config, static_cast<std::uint32_t>(pixels_.size()), seed);
    for (std::size_t i = 0; i < hot.pixels.size(); ++i)
      pixels_[hot.pixels[i]].hot_hz = hot.rates_hz[i];
  }

  void step(core::Time t, const core::Image<float>& luminance_lux,
            std::vector<core::Event>& events) {
    const auto from = events.size();
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      Pixel& pixel = pixels_[p];
      const double intensity = 255 * static_cast<double>(luminance_lux.pixels()[p]) / white_lux_;
      if (started_)
        advance(pixel, intensity, t, static_cast<int>(p), events);
      else
        start(pixel, intensity, t);
    }
    std::sort(events.begin() + static_cast<std::ptrdiff_t>(from), events.end(),
              [](const core::Event& a, const core::Event& b) {
                return std::tie(a.t, a.y, a.x) < std::tie(b.t, b.y, b.x);
              });
    now_ = t;
    started_ = true;
  }

 private:
  struct Pixel {
    double on, off, mean_leak_per_s, leak_per_s, hot_hz = 0;
    double intensity, log, lag = 0, residual;
    double shot_on_us, shot_off_us, hot_us;  ///< When they fire next.
  };

  /// residual(s) over the step, as sim/pixel.h has it.
  struct Course {
    double offset, slope, bend, rate;
    double at(double s) const { return offset + slope * s + bend * std::exp(-rate * s); }
  };

  double log_intensity(double intensity) const {
    const double knee = config_.log_linear_below;
    return intensity <= knee ? intensity * std::log(knee) / knee
                             : std::log(std::max(intensity, 0.01));
  }

  double next_us(double now_us, double rate_hz) {
    if (rate_hz <= 0) return std::numeric_limits<double>::infinity();
    return now_us + 1e6 / rate_hz * core::exponential(random_);
  }
  double shot_on_hz(const Pixel& p) const {
    return config_.shot_noise_rate_hz / 2 * config_.threshold_on_log / p.on;
  }
  double shot_off_hz(const Pixel& p) const {
    return config_.shot_noise_rate_hz / 2 * config_.threshold_off_log / p.off;
  }

  void start(Pixel& p, double intensity, core::Time t) {
    const auto now_us = static_cast<double>(t.count());
    p.intensity = intensity;
    p.log = log_intensity(intensity);
    p.residual = p.mean_leak_per_s > 0 ? core::uniform01(random_) * p.on : 0;
    p.shot_on_us = next_us(now_us, shot_on_hz(p));
    p.shot_off_us = next_us(now_us, shot_off_hz(p));
    p.hot_us = next_us(now_us, p.hot_hz);
  }

  void advance(Pixel& p, double intensity, core::Time t, int index,
               std::vector<core::Event>& events) {
    const auto begin_us = static_cast<double>(now_.count());
    const auto end_us = static_cast<double>(t.count());
    const double dt_us = end_us - begin_us;
    const double log = log_intensity(intensity);
    const double change = log - p.log;
    const double rate =
        2 * std::numbers::pi * config_.cutoff_hz / 275 *
        (ScalarPixel::mean_intensity(p.intensity, intensity, config_.log_linear_below) + 20) *
        dt_us * 1e-6;
    const double bend = rate > 0 ? p.lag + change / rate : 0;
    Course course{p.residual - bend, change + p.leak_per_s * dt_us * 1e-6, bend, rate};

    double s = 0;
    while (true) {
      const double noise_us = std::min({p.shot_on_us, p.shot_off_us, p.hot_us});
      const bool noisy = noise_us <= end_us;
      const double to = noisy ? (noise_us - begin_us) / dt_us : 1;
      const double residual = course.at(to);
      if (residual >= p.on || residual <= -p.off) {
        const double level = residual >= p.on ? p.on : -p.off;
        s = crossing(course, s, to, level, 0.05 / dt_us);
        fire(p, course, s, level, level > 0, dt_us, index, events);
      } else if (noisy) {
        s = to;
        noise(p, course, s, noise_us, p.intensity + (intensity - p.intensity) * s, dt_us, index,
              events);
      } else {
        p.residual = residual;
        break;
      }
    }
    p.lag = rate > 0 ? bend * std::exp(-rate) - change / rate : 0;
    p.intensity = intensity;
    p.log = log;
  }

  static double crossing(const Course& course, double low, double high, double level,
                         double tolerance) {
    while (high - low > tolerance) {
      const double middle = (low + high) / 2;
      const double residual = course.at(middle);
      ((level > 0 ? residual >= level : residual <= level) ? high : low) = middle;
    }
    return high;
  }

  void noise(Pixel& p, Course& course, double s, double t_us, double intensity, double dt_us,
             int index, std::vector<core::Event>& events) {
    bool on = true;
    if (t_us == p.hot_us) {
      p.hot_us = next_us(t_us, p.hot_hz);
    } else {
      on = t_us == p.shot_on_us;
      (on ? p.shot_on_us : p.shot_off_us) = next_us(t_us, on ? shot_on_hz(p) : shot_off_hz(p));
      if (core::uniform01(random_) >= sim::shot_noise_factor(intensity)) return;
    }
    fire(p, course, s, course.at(s), on, dt_us, index, events);
  }

  void fire(Pixel& p, Course& course, double s, double level, bool on, double dt_us, int index,
            std::vector<core::Event>& events) {
    const double leak_per_s = p.mean_leak_per_s / (1 + config_.leak_jitter * core::normal(random_));
    const double more = (leak_per_s - p.leak_per_s) * dt_us * 1e-6;
    p.leak_per_s = leak_per_s;
    course.offset -= level + more * s;
    course.slope += more;
    const auto offset_us = static_cast<int>(std::clamp(std::ceil(s * dt_us), 1.0, dt_us));
    events.push_back({now_ + core::Time(offset_us),
                      static_cast<std::uint16_t>(index % size_.width_px),
                      static_cast<std::uint16_t>(index / size_.width_px), on});
  }

  sim::PixelConfig config_;
  core::Resolution size_;
  double white_lux_;
  std::vector<Pixel> pixels_;
  core::Random random_;
  core::Time now_{};
  bool started_ = false;
};

}  // namespace nightjar::test
