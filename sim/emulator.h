#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "sim/emulator_counts.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// The event pixels: photoreceptor, thresholds, refractory period, leak, shot noise
/// and hot pixels, after v2e, with a crossing time of each event's own (as ESIM) and
/// a photoreceptor in closed form, so that the step size matters little: what is lost
/// is an excursion that comes and goes within one step. The closed form takes the
/// photoreceptor's rate constant k at its mean; a step over which a white pixel's
/// k dt exceeds 1 therefore goes in equal parts, 32 at most.
///
/// The noise processes run on their own clocks and streams: neither the step size
/// nor another effect's switch changes their draws.
class EventEmulator {
 public:
  /// `white_lux` is the luminance value of a white surface (255 on v2e's scale).
  /// Throws std::invalid_argument for a config out of range, `log_linear_below`
  /// between 0 and e, a size that is empty or over 32767 a side, white_lux not > 0.
  EventEmulator(const PixelConfig& config, core::Resolution size, double white_lux,
                std::uint64_t seed);
  ~EventEmulator();
  EventEmulator(EventEmulator&&) noexcept;
  EventEmulator& operator=(EventEmulator&&) noexcept;

  /// `luminance_lux` is reflectance times illuminance of each pixel at `t`; between
  /// two calls the log intensity is linear in time. The first call settles the
  /// pixels and gives no events; each other one appends those of (previous t, t],
  /// ordered by time, then y, then x.
  /// Negative radiance counts as 0. NaN, infinity and whatever is beyond +-1e20 count
  /// as not finite, and the pixel's last value holds (0 in the first call).
  /// Throws std::invalid_argument for another size, a time that does not increase,
  /// or a step of more than an hour; the pixels are then as before.
  void step(core::Time t, const core::Image<float>& luminance_lux,
            std::vector<core::Event>& events);

  const EmulatorCounts& counts() const;

  /// The frozen thresholds of all pixels, row-major.
  std::span<const float> thresholds_on_log() const;
  std::span<const float> thresholds_off_log() const;

 private:
  class Pixels;
  std::unique_ptr<Pixels> pixels_;
};

}  // namespace nightjar::sim
