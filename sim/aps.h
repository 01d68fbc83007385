#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/random.h"
#include "sim/aps_kernel.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// How long the shutter is open: `config.exposure_ms`, or, if that is 0, what the
/// light needs: 5 lux s, but never more than 0.5 s. An assumption made to meet the
/// one known point, 0.5 s at 2 to 10 lux (ESI paper).
core::Time aps_exposure(const ApsConfig& config, double illuminance_lux);

/// The frame camera in the same pixels (global shutter). The first exposure begins
/// with the first add(); the next one `interval_ms` after it, or when it ends.
class ApsSensor {
 public:
  /// `illuminance_lux` is the scene's light, and so a white surface's value.
  /// Throws std::invalid_argument for a config out of range, an empty size or an
  /// illuminance that is not > 0.
  ApsSensor(const ApsConfig& config, core::Resolution size, double illuminance_lux,
            std::uint64_t seed);

  /// The luminance at `t`, linear in time between calls, as EventEmulator takes it;
  /// NaN and negative values count as 0, infinite ones saturate. Gives the frame whose
  /// exposure has ended in (previous t, t].
  /// Throws std::invalid_argument for another size, a time that does not increase, or
  /// a step longer than the interval; the sensor is then as before.
  std::optional<core::ApsFrame> add(core::Time t, const core::Image<float>& luminance_lux);

  core::Time exposure() const { return exposure_; }
  core::Time interval() const { return interval_; }

  /// Inputs corrected so far: NaN, infinite or negative.
  std::uint64_t bad_radiance() const { return bad_radiance_; }

 private:
  void check(core::Time t, const core::Image<float>& luminance_lux) const;
  /// Adds to the charge what falls into the exposure of the step from `last_` to `t`.
  void expose(core::Time t, const core::Image<float>& luminance_lux);
  /// The same, and makes `t` and its light the last; counts inputs that had to be corrected.
  void expose_and_keep(core::Time t, const core::Image<float>& luminance_lux);
  core::ApsFrame read();

  ApsConfig config_;
  core::Time exposure_;
  core::Time interval_;
  std::vector<float> gain_;      ///< Electrons per lux s, fixed pattern included.
  std::vector<float> offset_e_;  ///< Fixed pattern.
  ApsConversion conversion_;
  core::Random noise_;  ///< One deviate a pixel and frame, of shot and read noise together.

  std::optional<core::Time> last_;
  core::Time begin_{};  ///< Of the exposure under way or the next one.
  core::Resolution size_;
  std::vector<float> last_lux_;  ///< At `last_`.
  std::vector<float> charge_lux_s_;
  std::uint64_t bad_radiance_ = 0;
};

}  // namespace nightjar::sim
