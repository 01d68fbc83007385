#include "sim/emulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/random.h"
#include "tests/support/sim_emulator_scenes.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;
using namespace test;

/// Log of an intensity with the presets' knee at 20, and the way back.
double knee_log(double intensity) { return ScalarPixel::log_intensity(intensity, 20); }
double of_knee_log(double log) {
  return log <= std::log(20.0) ? log * 20 / std::log(20.0) : std::exp(log);
}

/// From `i0` to `i1` in `ramp_s`, straight in the log, then still: the photoreceptor's
/// output at each microsecond, by Runge and Kutta's method with a rate constant that
/// follows the intensity all the way.
std::vector<double> true_output(double i0, double i1, double ramp_s, double cutoff_hz) {
  const double from = knee_log(i0), change = knee_log(i1) - from;
  const auto slope = [&](double t_s, double output) {
    const double log = from + change * std::min(1.0, t_s / ramp_s);
    return 2 * std::numbers::pi * cutoff_hz * (of_knee_log(log) + 20) / 275 * (log - output);
  };
  std::vector<double> outputs{from};
  constexpr double kStepS = 1e-6;
  for (int us = 0; us < 66'000; ++us) {
    const double t_s = us * kStepS, p = outputs.back();
    const double a = slope(t_s, p), b = slope(t_s + kStepS / 2, p + a * kStepS / 2);
    const double c = slope(t_s + kStepS / 2, p + b * kStepS / 2);
    const double d = slope(t_s + kStepS, p + c * kStepS);
    outputs.push_back(p + kStepS / 6 * (a + 2 * b + 2 * c + d));
  }
  return outputs;
}

/// How far the events, added up, are off the true output at most: at each event, and at the
/// end by more than a threshold.
double worst_off(const std::vector<Event>& events, const std::vector<double>& truth,
                 double threshold) {
  double memory = truth.front(), worst = 0;
  for (const Event& e : events) {
    memory += e.on ? threshold : -threshold;
    worst = std::max(worst, std::abs(memory - truth[static_cast<std::size_t>(e.t.count())]));
  }
  return std::max(worst, std::abs(memory - truth.back()) - threshold);
}

TEST(EventEmulator, low_pass_shrinks_a_sinusoid_as_the_closed_form_says) {
  // A small sinusoid about mid grey: k is nearly constant, so the output's amplitude
  // is A' = A / sqrt(1 + (w/k)^2). A pixel's memory walks on a lattice of one threshold;
  // each half period it passes the points between trough and peak, which for lattices
  // in all positions (a phase for each pixel) are 2 A'/theta, less the one it stands on.
  constexpr double kAmplitude = 0.1;
  constexpr double kThreshold = 0.01;
  constexpr double kMeanIntensity = 100;
  PixelConfig config = only_low_pass(30);
  config.threshold_on_log = config.threshold_off_log = kThreshold;
  const double k = 2 * std::numbers::pi * config.cutoff_hz * (kMeanIntensity + 20) / 275;
  const core::Resolution size{100, 1};
  for (const double hz : {2.0, 13.0, 40.0}) {
    const double omega = 2 * std::numbers::pi * hz;
    const Scene scene = [&](int x, int, double t_s) {
      return kMeanIntensity / 255 * kWhite_lux *
             std::exp(kAmplitude * std::sin(omega * t_s + 0.7 * x));
    };
    EventEmulator emulator(config, size, kWhite_lux, 5);
    constexpr int kPeriods = 40;
    const std::vector<Event> events =
        run(emulator, size, scene, core::from_seconds(kPeriods / hz), Time(1'000));
    const double amplitude = kAmplitude / std::hypot(1, omega / k);
    const double per_swing = static_cast<double>(events.size()) / (2.0 * kPeriods * size.width_px);
    // 100 lattices average to 5 * sqrt(1/12/100) = 0.15 at most; k itself swings by 8 %,
    // which moves the amplitude by about the square of that.
    EXPECT_NEAR(per_swing, 2 * amplitude / kThreshold - 1, 0.15 + 0.01 * per_swing) << hz;
  }
}

TEST(EventEmulator, low_pass_is_right_whatever_the_step) {
  // `dim`, noise-free, fine thresholds; the light is straight in the log over each step, so
  // that all that is off is the photoreceptor. The rate constant is taken at its mean over a
  // step or part of one, which is wrong in the second order of the part: the tolerances are
  // a fifth above what was measured, or half where it is large. In one 5 ms step k dt is
  // 0.94 at white and there is one part: the worst case.
  struct Case {
    double from, to;
    int ramp_us, step_us;
    double tolerance;
  };
  PixelConfig config = only_low_pass(30);
  config.threshold_on_log = config.threshold_off_log = 0.01;
  for (const Case& c : {Case{250, 22, 33'000, 1'000, 0.0007},
                        {250, 22, 33'000, 33'000, 0.012},
                        {250, 22, 30'000, 5'000, 0.012},
                        {250, 22, 5'000, 5'000, 0.15},
                        {22, 250, 33'000, 1'000, 0.0007},
                        {22, 250, 33'000, 33'000, 0.018},
                        {22, 250, 30'000, 5'000, 0.02},
                        {22, 250, 5'000, 5'000, 0.15},
                        {250, 2, 33'000, 33'000, 0.04},
                        {2, 250, 33'000, 33'000, 0.14}}) {
    const double ramp_s = 1e-6 * c.ramp_us;
    EventEmulator emulator(config, {1, 1}, kWhite_lux, 33);
    const Scene scene = [&](int, int, double t_s) {
      const double way = std::min(1.0, t_s / ramp_s);
      const double log = knee_log(c.from) + (knee_log(c.to) - knee_log(c.from)) * way;
      return of_knee_log(log) * kWhite_lux / 255;
    };
    const auto events = run(emulator, {1, 1}, scene, Time(66'000), Time(c.step_us));
    ASSERT_GT(events.size(), 100u);
    auto truth = true_output(c.from, c.to, ramp_s, 30);
    truth.resize(static_cast<std::size_t>(66'000 / c.step_us * c.step_us) + 1);
    const double off = worst_off(events, truth, 0.01);
    EXPECT_LT(off, c.tolerance) << c.from << " to " << c.to << " in " << c.ramp_us
                                << " us, steps of " << c.step_us << " us";
  }
}

TEST(EventEmulator, a_step_in_parts_is_one_step_to_everyone_else) {
  // 33 ms take seven parts in `dim`. What had to be corrected counts once, events are in
  // order, and noise comes as in steps of 1 ms.
  const core::Resolution size{40, 30};
  PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  config.leak_rate_hz = 0;
  EventEmulator coarse(config, size, kWhite_lux, 34), fine(config, size, kWhite_lux, 34);
  EXPECT_EQ(run(coarse, size, still(2), Time(990'000), Time(33'000)),
            run(fine, size, still(2), Time(990'000), Time(1'000)));

  EventEmulator emulator(config, size, kWhite_lux, 35);
  std::vector<Event> events;
  emulator.step(Time(0), picture(size, edge, 0), events);
  auto image = picture(size, edge, 0.2);
  image(0, 0) = std::numeric_limits<float>::quiet_NaN();
  image(1, 0) = -1.0f;
  image(2, 0) = -0.0f;
  EXPECT_THROW(emulator.step(Time(0), image, events), std::invalid_argument);
  emulator.step(Time(33'000), image, events);
  EXPECT_EQ(emulator.counts().not_finite_radiance, 1u);
  EXPECT_EQ(emulator.counts().negative_radiance, 1u);
  EXPECT_GT(events.size(), 100u);
  EXPECT_TRUE(
      std::ranges::is_sorted(events, {}, [](const Event& e) { return std::tuple(e.t, e.y, e.x); }));
  const auto is_nan_pixel = [](const Event& e) { return e.x == 0 && e.y == 0; };
  EXPECT_LE(std::ranges::count_if(events, is_nan_pixel), 2);  // its value holds: noise alone

  // The longest step and the fastest photoreceptor there are.
  config.cutoff_hz = 1e5;
  EventEmulator fast(config, size, kWhite_lux, 36);
  events.clear();
  fast.step(Time(0), picture(size, edge, 0), events);
  for (const Time t : {Time(1), Time(3), Time(6), Time(100), Time(1'000'000)})
    fast.step(t, picture(size, edge, core::seconds(t)), events);
  EXPECT_TRUE(
      std::ranges::is_sorted(events, {}, [](const Event& e) { return std::tuple(e.t, e.y, e.x); }));
}

}  // namespace
}  // namespace nightjar::sim
