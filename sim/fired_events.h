#pragma once

#include <cstdint>
#include <vector>

#include "core/event.h"
#include "sim/bucket_sort.h"

namespace nightjar::sim {

/// The events of one step as the pixels fire them, in any order.
class FiredEvents {
 public:
  /// `offset_us` after the begin of the step, `pixel` counted row by row, below 2^31.
  void add(std::uint32_t offset_us, std::uint32_t pixel, bool on) {
    keys_.push_back(static_cast<std::uint64_t>(offset_us) << 32 | pixel << 1 |
                    static_cast<std::uint32_t>(on));
  }

  /// Appends them to `events`, ordered by time, then y, then x (then OFF before ON), and
  /// forgets them. No offset exceeds `step`.
  void hand_over(core::Time begin, core::Time step, int width_px, std::vector<core::Event>& events);

 private:
  std::vector<std::uint64_t> keys_;
  BucketSort<std::uint64_t> order_;
};

}  // namespace nightjar::sim
