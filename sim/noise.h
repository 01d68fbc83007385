#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/random.h"
#include "sim/intensity.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// One point of a process over many pixels.
struct NoisePoint {
  double t_us;
  std::uint32_t source;  ///< Index into the rates given.
  float mark;            ///< Uniform in [0, 1), for thinning.
};

/// Independent Poisson processes of constant rates, drawn as one: the cost is by
/// point, not by pixel and step, and the points do not depend on the steps taken.
class PointProcess {
 public:
  /// Rates of 0 and an empty list are fine; negative ones are not.
  PointProcess(std::span<const double> rates_hz, core::Random random);

  /// The process begins at `t`. To be called once, before the first draw.
  void start(core::Time t);

  /// Appends the points of (previous until, until], ordered by time.
  void draw(core::Time until, std::vector<NoisePoint>& points);

 private:
  void draw_ahead();

  // Walker's alias method: column i holds source i up to `share`, above it `alias`.
  struct Column {
    std::uint32_t share;  ///< Of 2^32.
    std::uint32_t alias;
  };
  std::vector<Column> columns_;
  double mean_gap_us_ = 0;  ///< 0 = never.
  double last_us_ = 0;      ///< Of the points drawn.
  core::Random random_;
  // Points come in blocks, so that the misses of a table as large as the sensor overlap.
  static constexpr std::uint32_t kAhead = 64;
  std::array<NoisePoint, kAhead> ahead_;
  std::uint32_t next_ = kAhead;
};

/// Rates of shot noise of one polarity at intensity factor 1, per pixel (v2e's law):
/// R/2 * nominal threshold/own threshold.
std::vector<double> shot_noise_rates_hz(double shot_noise_rate_hz, double threshold_log,
                                        std::span<const float> thresholds_log);

/// v2e's intensity factor, 0.95 in the dark, 0.25 for white and above.
inline double shot_noise_factor(double intensity) {
  constexpr double kInWhite = 0.25;
  return 1 - (1 - kInWhite) * std::min(1.0, (intensity + kDarkOffset) * (1 / kWhiteWithOffset));
}

/// The hot pixels and their rates.
struct HotPixels {
  std::vector<std::uint32_t> pixels;
  std::vector<double> rates_hz;
};

/// Draws them; raising the fraction adds pixels and keeps the others as they are.
HotPixels draw_hot_pixels(const PixelConfig& config, std::uint32_t pixels, std::uint64_t seed);

/// Frozen Gaussian thresholds, none below 0.01.
std::vector<float> draw_thresholds_log(double mean_log, double sigma_log, std::size_t pixels,
                                       core::Random random);

}  // namespace nightjar::sim
