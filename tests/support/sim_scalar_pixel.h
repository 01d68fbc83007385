#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sensor_config.h"

namespace nightjar::test {

struct ScalarEvent {
  double t_us;
  bool on;
};

/// The plain pixel in double precision, one at a time, crossings by bisection: what the
/// emulator's fast one is held against. Noise-free but for a leak without jitter.
class ScalarPixel {
 public:
  ScalarPixel(const sim::PixelConfig& config, double white_lux, double threshold_on,
              double threshold_off)
      : config_(config), white_lux_(white_lux), on_(threshold_on), off_(threshold_off) {}

  static double log_intensity(double intensity, double knee) {
    if (intensity <= knee) return intensity * std::log(knee) / knee;
    return std::log(std::max(intensity, 0.01));
  }

  /// Over a step whose log intensity moves linearly.
  static double mean_intensity(double i0, double i1, double knee) {
    const double change = log_intensity(i1, knee) - log_intensity(i0, knee);
    if (std::abs(change) < 1e-6) return (i0 + i1) / 2;
    if (std::max(i0, i1) <= knee) return (i0 + i1) / 2;
    if (std::min(i0, i1) >= knee) return (i1 - i0) / change;
    // To the knee and on from there, each for its share of the step.
    const double to_knee = std::log(knee) - log_intensity(i0, knee);
    const double beyond = log_intensity(i1, knee) - std::log(knee);
    return (mean_intensity(i0, knee, knee) * to_knee + mean_intensity(knee, i1, knee) * beyond) /
           change;
  }

  void start(double t_us, double luminance_lux) {
    t_us_ = t_us;
    set_input(luminance_lux);
    output_ = memory_ = log_;
  }

  /// Events of (previous t, t].
  std::vector<ScalarEvent> step(double t_us, double luminance_lux) {
    std::vector<ScalarEvent> events;
    const ScalarPixel begin = *this;
    set_input(luminance_lux);
    const double dt_us = t_us - begin.t_us_;
    const double rate_hz =
        2 * std::numbers::pi * config_.cutoff_hz *
        (mean_intensity(begin.intensity_, intensity_, config_.log_linear_below) + 20) / 275;
    const auto output = [&](double after_us) {
      const double change = (log_ - begin.log_) * after_us / dt_us;
      const double a = rate_hz * after_us * 1e-6;
      if (config_.cutoff_hz == 0) return begin.log_ + change;
      if (a == 0) return begin.output_;
      return begin.log_ + change - change / a +
             (begin.output_ - begin.log_ + change / a) * std::exp(-a);
    };
    const double drift = config_.leak_rate_hz * on_ * 1e-6;
    double at_us = 0;  // in the step
    double memory_at_us = 0;
    if (awake_us_ > begin.t_us_) {
      at_us = awake_us_ - begin.t_us_;
      memory_at_us = std::min(at_us, dt_us);
      memory_ = output(memory_at_us);
    }
    const auto residual = [&](double after_us) {
      return output(after_us) - memory_ + drift * (after_us - memory_at_us);
    };
    while (at_us < dt_us) {
      const double last = residual(dt_us);
      if (last < on_ && last > -off_) break;
      const bool on = last >= on_;
      double low = at_us;
      double high = dt_us;
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        const bool beyond = on ? residual(middle) >= on_ : residual(middle) <= -off_;
        (beyond ? high : low) = middle;
      }
      events.push_back({begin.t_us_ + high, on});
      memory_ = output(high);
      memory_at_us = high;
      at_us = high + config_.refractory_us;
      if (config_.refractory_us == 0) continue;
      awake_us_ = begin.t_us_ + at_us;
      memory_at_us = std::min(at_us, dt_us);
      memory_ = output(memory_at_us);
    }
    memory_ -= drift * (dt_us - memory_at_us);
    output_ = output(dt_us);
    t_us_ = t_us;
    return events;
  }

  double output() const { return output_; }

 private:
  void set_input(double luminance_lux) {
    intensity_ = 255 * luminance_lux / white_lux_;
    log_ = log_intensity(intensity_, config_.log_linear_below);
  }

  sim::PixelConfig config_;
  double white_lux_;
  double on_, off_;
  double t_us_ = 0;
  double intensity_ = 0, log_ = 0, output_ = 0, memory_ = 0;
  double awake_us_ = -1e300;
};

}  // namespace nightjar::test
