#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "camera/recording.h"
#include "core/image.h"
#include "esi/packed_event.h"

namespace nightjar::scenarios {

/// Events, and frames where there are any, that the speed of reconstruction is measured on.
/// Times begin near 0 and stay below 71 minutes.
struct EventWorkload {
  /// As a camera hands events over.
  static constexpr core::Time kPacket{10'000};

  std::string name;
  core::Resolution size;
  std::vector<esi::PackedEvent> events;
  std::vector<core::ApsFrame> frames;
  std::vector<std::size_t> packet_ends;  ///< Into `events`; packet i ends at (i + 1) * kPacket.

  /// Cuts the events at multiples of kPacket.
  void cut_packets();
};

enum class EventPattern {
  uniform,       ///< Every pixel alike, at random.
  moving_edges,  ///< Eight slanted edges cross the sensor, a pixel firing a few times at each.
};

/// `count` events of a DAVIS346 (346x260), `rate_hz` of them a second, with a 10-bit frame
/// every 40 ms. The same seed gives the same events.
EventWorkload make_workload(EventPattern pattern, double rate_hz, std::size_t count,
                            std::uint64_t seed);

/// The six that speeds are told of: both patterns at 1, 5 and 12 million events a second.
inline constexpr std::size_t kWorkloads = 6;
EventWorkload make_workload(std::size_t index, std::size_t count);
std::string workload_name(std::size_t index);

/// The first `most` events of a recording, and the frames until then. Throws
/// std::invalid_argument for a recording without events, or as the reader does.
EventWorkload read_workload(camera::RecordingReader& recording, std::string name, std::size_t most);

}  // namespace nightjar::scenarios
