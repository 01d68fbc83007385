#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "esi/packed_event.h"

namespace nightjar::esi {

/// The latest events, side by side in memory. Keeps at most `most_events`, none that is older
/// than `most_age_us` (below 2^31) at the latest; holds room for twice as many at most and
/// allocates only to keep more than ever before.
class EventHistory {
 public:
  EventHistory(std::uint32_t most_age_us, std::size_t most_events)
      : most_age_us_(most_age_us), most_events_(most_events) {}

  /// `events` in order, none older than those before.
  void append(std::span<const PackedEvent> events);
  /// Forgets the first `count`.
  void drop_first(std::size_t count);
  /// Forgets what lies more than `age_us` before `now_us`.
  void drop_older(std::uint32_t now_us, std::uint32_t age_us);
  void clear();

  std::span<const PackedEvent> events() const { return std::span(buffer_).subspan(begin_); }

  /// Events forgotten since clear() for want of room alone.
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::uint32_t most_age_us_;
  std::size_t most_events_;
  std::vector<PackedEvent> buffer_;
  std::size_t begin_ = 0;  ///< Of those still kept.
  std::uint64_t dropped_ = 0;
};

}  // namespace nightjar::esi
