#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "camera/recording.h"
#include "core/event.h"

namespace nightjar::camera {

/// What a camera handed over at once: the events of (begin, end] and the frames, IMU
/// samples and triggers that were complete by then, ordered as in every RecordingPart.
/// `begin` is the `end` of the packet before, and the latest datum is at `end`.
struct LivePacket : RecordingPart {
  core::Time begin{};
  core::Time end{};
  /// Data of (begin, end] are missing: the reader was too slow or the camera was away.
  bool gap = false;
  /// When it came, by the computer's own clock; from here on latency is ours.
  std::chrono::steady_clock::time_point received;
};

/// What EventSource::next() has to say.
enum class Arrival {
  packet,        ///< A packet was written.
  silent,        ///< Nothing came for about a second, or the camera is still away.
  disconnected,  ///< The camera went away just now; said once. The source keeps trying.
  end,           ///< stop() was called, or nothing will ever come again.
};

/// So far, since start().
struct SourceCounts {
  std::uint64_t packets = 0;  ///< Handed over, and what was in them:
  std::uint64_t events = 0;
  std::uint64_t frames = 0;
  std::uint64_t imu = 0;
  std::uint64_t triggers = 0;
  std::uint64_t packets_lost = 0;  ///< Dropped because the reader was too slow.
  std::uint64_t disconnects = 0;
  std::uint64_t reconnects = 0;
  RecordingFaults faults;  ///< Of data that could not be used as it came.

  bool any_loss() const { return packets_lost > 0 || disconnects > 0 || faults.any(); }
};

/// A camera that runs on its own: it does not wait for who reads it. One thread calls
/// start() and next(); stop() and counts() may be called by any.
class EventSource {
 public:
  virtual ~EventSource() = default;

  /// As messages name it ("DAVIS346 00000123"); complete after start().
  virtual std::string name() const = 0;

  virtual core::Resolution size() const = 0;

  /// Opens the camera and begins; once. Throws std::invalid_argument, with what to do
  /// about it, when there is none to be had.
  virtual void start() = 0;

  /// Waits for the next packet and replaces what `packet` held; every Arrival but `packet`
  /// leaves it empty. Times run on from packet to packet whatever the camera's clock does:
  /// wraps are undone, and over a reset or an outage they go on by the computer's clock.
  /// After `end` it says `end` for ever.
  virtual Arrival next(LivePacket& packet) = 0;

  /// Makes next() return `end`, one that waits just now within milliseconds, whatever the
  /// camera does. Not to be called from a signal handler. A stopped source does not start
  /// again.
  virtual void stop() = 0;

  virtual SourceCounts counts() const = 0;
};

}  // namespace nightjar::camera
