#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "esi/memory_cell.h"

namespace nightjar::esi {

/// MemoryVariant::integrate by `kTake`, which takes one event. Cells come from the second or
/// third cache, so they are fetched ahead, but not far: nearly each lies in a page of its own,
/// and of those a processor has some 70 at hand.
template <void (*kTake)(const PackedEvent&, MemoryCell*)>
[[gnu::always_inline]] inline void integrate_blocks(EventRun& events, MemoryCell* cells) {
  constexpr std::size_t kBlock = 128, kAhead = 24;
  const auto first = reinterpret_cast<std::uintptr_t>(cells);
  EventRun run = events;
  for (auto block = run.next(kBlock); !block.empty(); block = run.next(kBlock)) {
    // Perhaps not checked yet: as a number an address may lie anywhere, and to fetch from where
    // nothing is does no harm.
    const PackedEvent* ahead = block.data() + std::min(kAhead, run.rest().size());
    for (std::size_t i = 0; i < block.size(); ++i) {
      // Either half of the cell will do, which saves taking the polarity off.
      const std::uintptr_t half = first + sizeof(MemoryCell) / 2 * ahead[i].pixel_on;
      __builtin_prefetch(reinterpret_cast<const void*>(half), 1);
      kTake(block[i], cells);
    }
  }
  events = run;
}

}  // namespace nightjar::esi
