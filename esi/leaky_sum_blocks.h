#pragma once

#include <cstddef>
#include <cstdint>

#include "esi/leaky_sum_event.h"

namespace nightjar::esi {

/// Events whose losses are worked out at once: the cells they touch stay in the first
/// cache, and there is enough to fill vectors.
inline constexpr std::size_t kLeakyBlock = 64;

/// A pixel's ages depend on nothing but its events' times, so the losses of a whole block
/// are worked out in vectors, after a walk over the times and before one over the sums. The
/// latter goes along with the next block's first: the two have nothing to wait for from
/// each other.
template <Leak kLeak, bool kLeakFirst>
[[gnu::always_inline]] inline void take_blocks(const LeakySum& constants, EventRun& events,
                                               SumCell* cells) {
  const LeakySum c = constants;  // copies: the stores below cannot change them
  EventRun run = events;
  alignas(64) std::uint32_t age_us[kLeakyBlock];
  alignas(64) float lost[kLeakyBlock];
  auto block = run.next(kLeakyBlock);
  for (std::size_t i = 0; i < block.size(); ++i) age_us[i] = take_age(block[i], cells);
  while (!block.empty()) {
    work_out<kLeak>(c, age_us, block.size(), lost);
    const auto next = run.next(kLeakyBlock);  // no longer than `block`
    for (std::size_t i = 0; i < next.size(); ++i) {
      age_us[i] = take_age(next[i], cells);
      add_event<kLeak, kLeakFirst>(c, block[i].on(), lost[i], cells[block[i].pixel()].sum);
    }
    for (std::size_t i = next.size(); i < block.size(); ++i)
      add_event<kLeak, kLeakFirst>(c, block[i].on(), lost[i], cells[block[i].pixel()].sum);
    block = next;
  }
  events = run;
}

template <bool kLeakFirst>
[[gnu::always_inline]] inline void integrate_blocks(const LeakySum& c, EventRun& events,
                                                    SumCell* cells) {
  switch (c.leak) {
    case Leak::linear: return take_blocks<Leak::linear, kLeakFirst>(c, events, cells);
    case Leak::power: return take_blocks<Leak::power, kLeakFirst>(c, events, cells);
    case Leak::smooth_power: return take_blocks<Leak::smooth_power, kLeakFirst>(c, events, cells);
    case Leak::exponential: return take_blocks<Leak::exponential, kLeakFirst>(c, events, cells);
    case Leak::slope: return take_blocks<Leak::slope, kLeakFirst>(c, events, cells);
  }
}

/// Takes events to the run's end.
[[gnu::always_inline]] inline void integrate_blocks(const LeakySum& c, EventRun& events,
                                                    SumCell* cells) {
  c.leak_first ? integrate_blocks<true>(c, events, cells)
               : integrate_blocks<false>(c, events, cells);
}

}  // namespace nightjar::esi
