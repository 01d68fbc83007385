#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/event.h"
#include "scenarios/pixel_activity.h"

namespace nightjar::scenarios {

/// A share of ON among some events, and how many OFF came for each ON; nothing where
/// there are no events to divide by.
struct PolarityShare {
  std::uint64_t events = 0;
  std::optional<double> on_share;
  std::optional<double> off_per_on;
};

struct QuietPixels {
  std::uint64_t pixels = 0;
  PolarityShare polarity;
  std::optional<double> rate_hz;        ///< Of a pixel; nothing without such pixels.
  std::optional<double> rate_error_hz;  ///< One Poisson deviation; without events, of one.
};

struct HotPixel {
  int x;
  int y;
  double rate_hz;
};

struct HotPixelFigures {
  std::vector<HotPixel> pixels;  ///< Hottest first.
  std::optional<double> rate_median_hz;
  std::optional<double> share_of_events;
};

inline constexpr std::array<double, 6> kIntervalQuantiles = {0.001, 0.01, 0.1, 0.5, 0.9, 0.99};

/// Between neighbouring events of one pixel, hot pixels aside; nothing without any.
struct IntervalFigures {
  std::uint64_t intervals = 0;
  std::optional<std::int64_t> minimum_us;
  std::array<std::optional<std::int64_t>, kIntervalQuantiles.size()> quantiles_us;
};

/// The figures by which event sensors are compared. Pixels are quiet, hot or signal as
/// classify_pixels() says; rates are events of a pixel in a second.
struct EventStatistics {
  core::Resolution size;
  double duration_s = 0;
  PolarityShare all;
  double rate_mean_hz = 0;
  double rate_median_hz = 0;
  double rate_99_hz = 0;  ///< 99 % of the pixels fire no more than that.
  QuietPixels quiet;
  HotPixelFigures hot;
  std::uint64_t signal_pixels = 0;
  PolarityShare signal;
  IntervalFigures intervals;
};

/// The smallest value that a share `q` (0 to 1) of the ascending values does not exceed;
/// nothing without values.
std::optional<std::int64_t> quantile(std::span<const std::int64_t> ascending, double q);

EventStatistics event_statistics(const PixelActivity& activity);

}  // namespace nightjar::scenarios
