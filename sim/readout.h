#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/event.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

struct ReadoutCounts {
  std::uint64_t read = 0;
  std::uint64_t lost = 0;  ///< Came while the queue was full.
  core::Time max_delay{};  ///< From the pixel's request to its readout.
};

/// The row arbiter between pixels and host. One event takes 1/max_event_rate_hz.
/// Rows are served in the order in which they asked; a row's turn reads all its
/// pixels that wait at that moment, in the order of their requests.
class Readout {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Readout(const ReadoutConfig& config, core::Resolution size);

  /// Takes the requests of (previous until, until], ordered by time, and appends the
  /// events whose readout begins by `until`, stamped and ordered by that time. The
  /// rest waits for the next call.
  /// Throws std::invalid_argument for a request out of order, later than `until` or
  /// outside the sensor; the readout is then as before.
  void step(core::Time until, std::span<const core::Event> requests,
            std::vector<core::Event>& events);

  const ReadoutCounts& counts() const { return counts_; }
  int waiting() const { return waiting_; }

 private:
  void check(core::Time until, std::span<const core::Event> requests) const;
  /// Queues every request made by the time the arbiter has come to.
  void admit(std::span<const core::Event>& requests);

  ReadoutConfig config_;
  core::Resolution size_;
  std::int64_t service_ps_;   ///< Picoseconds an event takes.
  std::int64_t free_ps_ = 0;  ///< When the arbiter can read the next event.
  core::Time until_{INT64_MIN};
  int waiting_ = 0;
  int turn_left_ = 0;                          ///< Events left of the front row's turn.
  std::deque<std::uint16_t> asking_rows_;      ///< Front has its turn.
  std::vector<std::deque<core::Event>> rows_;  ///< What waits in each row.
  ReadoutCounts counts_;
};

}  // namespace nightjar::sim
