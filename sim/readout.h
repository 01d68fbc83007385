#pragma once

#include <cstdint>
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
  /// A request that waits; of an unused one only `next` counts.
  struct Slot {
    core::Event request;
    std::uint32_t next;
  };
  /// What waits in a row, first come first served.
  struct Row {
    std::uint32_t first = 0, last = 0;  ///< Of `slots_`.
    int waiting = 0;
    std::uint16_t next_asking = 0;
  };

  void check(core::Time until, std::span<const core::Event> requests) const;
  /// Queues every request made by `now`, the time the arbiter has come to.
  void admit(core::Time now, std::span<const core::Event>& requests);
  /// With nothing waiting, reads requests from the front of `requests` on, as long as the
  /// rows' turns come in their order: those that the arbiter finds together are in the order
  /// of rows, and nobody asks before the last one's turn.
  void read_in_order(std::span<const core::Event>& requests, std::vector<core::Event>& events);
  /// The next request of the row whose turn it is; valid until the next admit().
  const core::Event& take_next();
  void ask(std::uint16_t y);

  ReadoutConfig config_;
  core::Resolution size_;
  std::int64_t service_ps_;   ///< Picoseconds an event takes.
  std::int64_t free_ps_ = 0;  ///< When the arbiter can read the next event.
  core::Time until_{INT64_MIN};
  int waiting_ = 0;
  int turn_left_ = 0;        ///< Events left of the turn of `first_asking_`.
  std::vector<Slot> slots_;  ///< Lists of what waits in each row, and of unused ones.
  std::uint32_t unused_ = 0;
  std::vector<Row> rows_;
  std::uint16_t first_asking_ = 0, last_asking_ = 0;  ///< Rows in a list, if any waits.
  ReadoutCounts counts_;
};

}  // namespace nightjar::sim
