#pragma once

#include <cstdint>
#include <vector>

#include "core/event.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// The camera's own filter: an event passes only if one of its pixel's 8 neighbours
/// fired at most `window_us` before it. Dropped events count as firing, too.
class BackgroundActivityFilter {
 public:
  /// Throws std::invalid_argument for a config out of range.
  BackgroundActivityFilter(const BackgroundActivityConfig& config, core::Resolution size);

  /// Removes from `events` (ordered by time, also from call to call; on the sensor)
  /// what does not pass. With `enabled` false everything passes.
  void filter(std::vector<core::Event>& events);

  std::uint64_t dropped() const { return dropped_; }

 private:
  bool passes(const core::Event& event);

  BackgroundActivityConfig config_;
  std::size_t stride_;
  std::vector<std::int64_t> last_us_;  ///< Last event of each pixel, with a rim of 1.
  std::uint64_t dropped_ = 0;
};

}  // namespace nightjar::sim
