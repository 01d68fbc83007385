#pragma once

#include <cstddef>
#include <cstdint>

#include "esi/memory_cell.h"

namespace nightjar::esi {

/// A cell as a register: its sums, and its time as the last lane.
inline constexpr int kMemoryLanes = kMemories + 1;
inline constexpr int kTimeLane = kMemories;
/// Added before a feature's fraction is dropped, which rounds downwards above 0 alone.
inline constexpr int kFeatureLift = 2 * kFeatureOne;
static_assert(sizeof(MemoryCell) == kMemoryLanes * sizeof(float));

/// kPixelMemories, a register for each member, and something harmless in the time's place.
struct alignas(64) MemoryConstants {
  /// What an event adds ahead of the decay, as in ESI, and behind it, where moving.
  struct Step {
    float before[kMemoryLanes] = {};
    float after[kMemoryLanes] = {};
  };
  Step step[2];  ///< Of an OFF and an ON event.
  float rate_per_us[kMemoryLanes] = {};
  float most[kMemoryLanes] = {};
  float least[kMemoryLanes] = {};
  std::int32_t is_sum[kMemoryLanes] = {};   ///< All ones, or 0.
  std::int32_t is_time[kMemoryLanes] = {};  ///< The same.
  float stays[kMemoryLanes] = {};           ///< 1 where nothing decays up to the picture.
  /// A feature is scale v / (1 + squeeze |v|), the time's 1 / (1 + squeeze age).
  float scale[kMemoryLanes] = {};
  float squeeze[kMemoryLanes] = {};
};

constexpr MemoryConstants make_memory_constants() {
  MemoryConstants c;
  for (int i = 0; i < kMemories; ++i) {
    const Memory& m = kPixelMemories[static_cast<std::size_t>(i)];
    c.rate_per_us[i] = m.rate_hz * 1e-6f;
    c.most[i] = m.most_events;
    c.least[i] = -m.most_events;
    (m.moving ? c.step[0].after : c.step[0].before)[i] = m.activity ? 1.0f : -1.0f;
    (m.moving ? c.step[1].after : c.step[1].before)[i] = 1.0f;
    c.is_sum[i] = -1;
    c.stays[i] = m.moving ? 0.0f : 1.0f;
    const bool is_long = m.most_events > 10.0f;
    c.scale[i] = is_long ? 0.5f : 2.0f / m.most_events;
    c.squeeze[i] = is_long ? 0.25f : 0.0f;
  }
  c.is_time[kTimeLane] = -1;
  c.scale[kTimeLane] = 1.0f;
  c.squeeze[kTimeLane] = 1e-5f;  // 1 / (100 ms)
  return c;
}

inline constexpr MemoryConstants kMemoryConstants = make_memory_constants();

}  // namespace nightjar::esi
