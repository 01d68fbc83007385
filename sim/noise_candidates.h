#pragma once

#include <span>
#include <vector>

#include "core/event.h"
#include "sim/bucket_sort.h"
#include "sim/noise.h"

namespace nightjar::sim {

/// A noise event that a pixel may fire.
struct NoiseCandidate {
  enum Kind : std::uint32_t { shot_off, shot_on, hot };

  double t_us;
  std::uint32_t pixel;
  float mark;  ///< Uniform in [0, 1), for thinning.
  Kind kind;
};

/// Shot noise and hot pixels of a whole sensor, each process on its own clock and stream:
/// neither the steps taken nor another effect's switch changes the draws.
class NoiseCandidates {
 public:
  /// The thresholds of all pixels, row by row.
  NoiseCandidates(const PixelConfig& config, std::span<const float> thresholds_on_log,
                  std::span<const float> thresholds_off_log, std::uint64_t seed);

  /// The processes begin at `t`. To be called once, before the first draw.
  void start(core::Time t);

  /// Those of (previous until, until], ordered by pixel, then time; valid until the next call,
  /// the caller's to change.
  std::span<NoiseCandidate> draw(core::Time until);

 private:
  void draw(PointProcess& process, core::Time until, NoiseCandidate::Kind kind);

  std::uint32_t pixels_;
  HotPixels hot_pixels_;
  PointProcess shot_on_, shot_off_, hot_;
  std::vector<NoisePoint> points_;
  std::vector<NoiseCandidate> candidates_;
  BucketSort<NoiseCandidate> order_;
};

}  // namespace nightjar::sim
