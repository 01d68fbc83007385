#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/course_kernel.h"
#include "sim/emulator_counts.h"
#include "sim/fired_events.h"
#include "sim/leak.h"
#include "sim/noise_candidates.h"
#include "sim/pixel.h"
#include "sim/pixel_kernel.h"

namespace nightjar::sim {

/// Takes those pixels through a step event by event that fire in it or rest. They go
/// side by side, so that their next crossings are found together.
class PixelWalks {
 public:
  PixelWalks(const PixelConfig& config, std::uint32_t pixels, Leak leak);

  const Leak& leak() const { return leak_; }

  /// No walk may be pending.
  void begin_step(core::Time begin, core::Time dt);

  /// Pixel `first_pixel + i` is to walk, where `i` is its place in `block`, which has
  /// already been advanced. `noise` are its noise events of the step, ordered by time;
  /// both have to stay until `run`.
  void add(std::uint32_t first_pixel, std::uint32_t i, PixelBlock& block, const BlockStep& before,
           std::span<const NoiseCandidate> noise);

  /// Makes room for `count` more by running those that wait, if need be.
  void make_room(std::uint32_t count, FiredEvents& fired, EmulatorCounts& counts) {
    if (starts_.count + count > kMostCourses) run(fired, counts);
  }

  /// Walks them all to the end of the step: adds their events to `fired` and sets their
  /// residuals.
  void run(FiredEvents& fired, EmulatorCounts& counts);

  /// Pixels that rest beyond the step, ascending. To be asked once a step.
  std::vector<std::uint32_t> take_resting();

 private:
  /// Its course has the same index in `starts_`.
  struct Walk {
    std::span<const NoiseCandidate> noise;  ///< Still to come.
    float threshold_on, threshold_off;
    PixelBlock* block;
    std::uint32_t i;
    std::uint32_t pixel;
    double awake = 0;  ///< The pixel can fire from here on.
  };

  void set_off();
  bool go_to_crossing(std::uint32_t k, FiredEvents& fired, EmulatorCounts& counts);
  void fire(std::uint32_t k, double s, double level, bool on, FiredEvents& fired);
  void finish(std::uint32_t k);
  double in_step(double t_us) const { return (t_us - begin_us_) * per_us_; }

  double refractory_us_;
  Leak leak_;
  std::vector<double> rest_until_us_;  ///< Of all pixels; empty without refractory period.
  std::vector<std::uint32_t> resting_;

  double begin_us_ = 0;
  double dt_us_ = 0;
  double per_us_ = 0;  ///< 1/dt_us_
  std::vector<Walk> walks_;
  CourseStarts starts_;
  std::vector<std::uint32_t> open_;  ///< Of `walks_`, not yet at the end of the step.
  Crossings crossings_;              ///< Those of `open_`.
};

inline void PixelWalks::add(std::uint32_t first_pixel, std::uint32_t i, PixelBlock& block,
                            const BlockStep& before, std::span<const NoiseCandidate> noise) {
  const std::uint32_t k = starts_.count++;
  starts_.change[k] = before.change[i];
  starts_.leak_per_s[k] = block.leak_per_s[i];
  starts_.lag[k] = before.lag[i];
  starts_.residual[k] = before.residual[i];
  starts_.rate[k] = before.kdt[i];
  walks_.push_back(
      {noise, block.threshold_on[i], block.threshold_off[i], &block, i, first_pixel + i});
  leak_.prefetch(first_pixel + i);
}

}  // namespace nightjar::sim
