#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/random.h"

namespace nightjar::test {

/// EDI's equations in doubles. The mean of L over the exposure is the frame; E(t) is piecewise
/// constant, so the integral is a sum over the times between a pixel's events.
class DoubleIntegralByTheEquations {
 public:
  DoubleIntegralByTheEquations(const core::ApsFrame& frame, const std::vector<core::Event>& events,
                               double contrast_log)
      : frame_(frame), events_(events), c_(contrast_log) {}

  /// L(t), 1 = the frame's white; events up to and with `t`.
  double latent(int x, int y, core::Time t) const {
    const double b = core::seconds(frame_.exposure_begin);
    const double e = core::seconds(frame_.exposure_end);
    double integral = 0, from = b;
    int n = 0;
    for (const core::Event& event : at(x, y)) {
      if (event.t >= frame_.exposure_end) break;
      integral += (core::seconds(event.t) - from) * std::exp(c_ * n);
      from = core::seconds(event.t);
      n += event.on ? 1 : -1;
    }
    integral += (e - from) * std::exp(c_ * n);
    const double white = (1 << frame_.bits) - 1;
    const double blurred = std::max<double>(frame_.gray(x, y), 0.5) / white;
    int to_t = 0;
    for (const core::Event& event : at(x, y))
      if (event.t <= t) to_t += event.on ? 1 : -1;
    return blurred / (integral / (e - b)) * std::exp(c_ * to_t);
  }

 private:
  std::vector<core::Event> at(int x, int y) const {
    std::vector<core::Event> here;
    for (const core::Event& e : events_)
      if (e.x == x && e.y == y && e.t >= frame_.exposure_begin) here.push_back(e);
    return here;
  }

  core::ApsFrame frame_;
  std::vector<core::Event> events_;
  double c_;
};

/// A checkerboard of 12 pixels a field that moves by `travel_px` during an exposure of 40 ms: the
/// frame it leaves, its events at thresholds of `contrast_log` and how it looks in the end.
struct MovingCheckerboard {
  static constexpr core::Resolution kSize{96, 72};
  static constexpr core::Time kExposure{40000};

  core::ApsFrame frame{core::Time{}, kExposure, 10, core::Image<std::uint16_t>(kSize)};
  std::vector<core::Event> events;
  core::Image<double> end{kSize};  ///< 1 = the frame's white.

  MovingCheckerboard(double travel_px, double contrast_log) {
    constexpr int kSteps = 200;
    std::multimap<std::int64_t, core::Event> ordered;
    core::Random random = core::random_stream(/*seed=*/6, "test.checkerboard");
    for (int y = 0; y < kSize.height_px; ++y)
      for (int x = 0; x < kSize.width_px; ++x) {
        end(x, y) = brightness(x, y, travel_px);
        double kept =
            std::log(brightness(x, y, 0)) + contrast_log * (core::uniform01(random) - 0.5);
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
          const double share = (i + 0.5) / kSteps;
          const double now = brightness(x, y, share * travel_px);
          sum += now;
          const core::Time t(static_cast<std::int64_t>(share * kExposure.count()));
          for (; std::log(now) >= kept + contrast_log; kept += contrast_log)
            ordered.insert({t.count(), event(t, x, y, true)});
          for (; std::log(now) <= kept - contrast_log; kept -= contrast_log)
            ordered.insert({t.count(), event(t, x, y, false)});
        }
        frame.gray(x, y) = static_cast<std::uint16_t>(std::lround(sum / kSteps * 1023));
      }
    for (const auto& [t, e] : ordered) events.push_back(e);
  }

 private:
  static core::Event event(core::Time t, int x, int y, bool on) {
    return {t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), on};
  }
  /// The mean over the pixel's width of fields of 0.15 and 0.8.
  static double brightness(int x, int y, double moved_px) {
    constexpr int kSamples = 4;
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double u = x + (i + 0.5) / kSamples - 0.8 * moved_px;
      const double v = y - 0.6 * moved_px;
      const int field = static_cast<int>(std::floor(u / 12) + std::floor(v / 12));
      sum += field % 2 == 0 ? 0.15 : 0.8;
    }
    return sum / kSamples;
  }
};

}  // namespace nightjar::test
