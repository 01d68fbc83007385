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

/// The whole sensor behind the lens: pixels, readout, the camera's noise filter and
/// the active pixels.
class SimulatedCamera {
 public:
  /// Throws std::invalid_argument for a config out of range.
  SimulatedCamera(const SensorConfig& config, core::Resolution size, double illuminance_lux,
                  std::uint64_t seed);

  /// The luminance at `t`, later than in the call before.
  void expose(core::Time t, const core::Image<float>& luminance_lux);

  /// All events read out since the packet before.
  core::EventPacket take_packet();
  /// The frames completed since the last call.
  std::vector<core::ApsFrame> take_frames();

  const EmulatorCounts& pixel_counts() const { return emulator_.counts(); }
  const ReadoutCounts& readout_counts() const { return readout_.counts(); }
  std::vector<core::StageTime> stage_times() const;

 private:
  EventEmulator emulator_;
  Readout readout_;
  BackgroundActivityFilter filter_;
  ApsSensor aps_;
  core::Time packet_begin_{};
  core::Time now_{};
  std::vector<core::Event> requests_;
  std::vector<core::Event> events_;
  std::vector<core::ApsFrame> frames_;
  core::StageTimer emulating_{"emulate pixels", "camera"};
  core::StageTimer reading_out_{"read out", "camera"};
  core::StageTimer exposing_{"expose APS", "camera"};
};

}  // namespace nightjar::sim
