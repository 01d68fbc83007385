#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "camera/frame_source.h"
#include "core/event.h"
#include "sim/sensor_config.h"

namespace nightjar::scenarios {

struct EmulateOptions {
  sim::SensorConfig sensor;
  double illuminance_lux = 5.0;  ///< Only `by_illuminance` asks for it.
  std::uint64_t seed = 1;
  /// Called once, before the first events, with the sensor's size.
  std::function<void(core::Resolution)> on_start;
  /// Called after every frame with the time reached and that of the last frame (0 when
  /// a video does not tell). May throw to stop.
  std::function<void(double done_s, double end_s)> on_progress;
};

/// What came of a sequence of frames.
struct Emulation {
  core::Resolution size;
  double rate_hz = 0;  ///< Of the frames.
  int frames = 0;
  int announced_frames = 0;  ///< See FrameSource.
  double duration_s = 0;     ///< From the first frame to the last.
  std::uint64_t events_on = 0;
  std::uint64_t events_off = 0;
  std::uint64_t events_lost = 0;  ///< In the readout, its queue being full.
  core::Time max_delay{};         ///< The longest wait of an event for its readout.
  std::uint64_t bad_values = 0;   ///< See FrameSource.
  double event_rate_hz = 0;       ///< All events over `duration_s`.
};

/// Shows `frames` to the emulated sensor, the first at t = 0, where the pixels settle;
/// between two frames each pixel's log intensity is linear in time. White (1) is 255 on
/// the emulator's scale, whatever the illuminance. After every frame `take` gets the
/// events read out since the one before, ordered by time; in the end what still waits in
/// the readout then, with times after the last frame (by about 1 ms at most by default).
///
/// The same frames, options and build give the same events. Throws
/// std::invalid_argument for what the frame source and the sensor refuse and for fewer
/// than two frames.
Emulation emulate(camera::FrameSource& frames, const EmulateOptions& options,
                  const std::function<void(std::span<const core::Event>)>& take);

std::string to_json(const Emulation& emulation);

/// As people read it.
std::string to_table(const Emulation& emulation);

/// One line on what was not as it should be with the frames, or nothing.
std::string warning(const Emulation& emulation);

}  // namespace nightjar::scenarios
