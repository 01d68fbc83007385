#pragma once

#include <cstdint>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/stage_timer.h"
#include "sim/aps.h"
#include "sim/background_activity_filter.h"
#include "sim/emulator.h"
#include "sim/readout.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// What a camera hands over at the end of a packet.
struct CameraOutput {
  core::EventPacket packet;
  std::vector<core::ApsFrame> frames;  ///< Those completed in the packet's time.
};

/// The whole sensor behind the lens: pixels, readout, the camera's noise filter and
/// the active pixels.
class SimulatedCamera {
 public:
  /// Throws std::invalid_argument for a config out of range.
  SimulatedCamera(const SensorConfig& config, core::Resolution size, double illuminance_lux,
                  std::uint64_t seed);

  /// The luminance at `t`, later than in the call before.
  void expose(core::Time t, const core::Image<float>& luminance_lux);

  /// What has come since the packet before, which began at time 0 if this is the first, up
  /// to and including `end`. What is later stays for the packets to come. `end` must not be
  /// before the last one nor after the last exposure.
  CameraOutput take(core::Time end);

  const EmulatorCounts& pixel_counts() const { return emulator_.counts(); }
  const ReadoutCounts& readout_counts() const { return readout_.counts(); }
  std::vector<core::StageTime> stage_times() const;

 private:
  EventEmulator emulator_;
  Readout readout_;
  BackgroundActivityFilter filter_;
  ApsSensor aps_;
  core::Time packet_begin_{};
  core::Time exposed_{};  ///< The last time of expose().
  std::vector<core::Event> requests_;
  std::vector<core::Event> events_;
  std::vector<core::ApsFrame> frames_;
  core::StageTimer emulating_{"emulate pixels", "loop"};
  core::StageTimer reading_out_{"read out", "loop"};
  core::StageTimer exposing_{"expose APS", "loop"};
};

}  // namespace nightjar::sim
