#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "esi/event_run.h"

namespace nightjar::esi {

/// How one of a pixel's sums remembers. With e = +1 for an ON event and -1 for an OFF one,
/// and left(dt) = max(1 - rate dt, 0), where dt is the time since the pixel's last event:
///
///   moving:  sum = clamp(sum left(dt) + e), and decays up to the picture;
///   else:    sum = clamp((sum + e) left(dt)) as ESI's, and stays while nothing happens.
struct Memory {
  float rate_hz;
  float most_events;  ///< clamp() is to +-this.
  bool moving;
  bool activity;  ///< e is +1 for an OFF event, too.
};

inline constexpr int kMemories = 7;
inline constexpr std::array<Memory, kMemories> kPixelMemories{{{0.5f, 5.0f, false, false},
                                                               {0.5f, 1.5f, false, false},
                                                               {1.0f, 16.0f, true, false},
                                                               {15.0f, 8.0f, true, false},
                                                               {50.0f, 8.0f, true, false},
                                                               {150.0f, 8.0f, true, false},
                                                               {2.0f, 32.0f, true, true}}};

/// A pixel's sums and the time of its last event: half a cache line.
struct alignas(32) MemoryCell {
  std::array<float, kMemories> sum{};  ///< In events.
  std::uint32_t t_us = 0;
};

/// What a pixel tells of itself: its sums, and how long ago its last event was.
inline constexpr int kPixelFeatures = kMemories + 1;
/// A feature of 1 in whole numbers.
inline constexpr int kFeatureOne = 512;

/// What is done to cells, for one instruction set.
struct MemoryVariant {
  const char* name;
  /// Takes events to the run's end. A time between a pixel's events is below 2^31 us.
  void (*integrate)(EventRun&, MemoryCell* cells);
  /// The kPixelFeatures of `width` cells side by side, for blocks two pixels wide and two
  /// high: those of cell x begin at to[x / 2 * 4 * kPixelFeatures + x % 2 * kPixelFeatures].
  /// An odd last cell stands in for its missing neighbour. A sum v, decayed up to `now_us`
  /// where it is moving, gives 2 v / most, but v / (2 + |v| / 2) where most exceeds 10:
  /// whether 20 or 25 events says little. The last feature is 1 / (1 + age / 100 ms). An
  /// age from 2^31 us on counts as 2^31 - 1. Rounded to whole numbers, halves upwards.
  void (*features)(const MemoryCell* cells, int width, std::uint32_t now_us, std::int16_t* to);
};

/// Those this processor can run, slowest first. All give the same bits.
std::vector<MemoryVariant> memory_variants();

/// The last of them.
const MemoryVariant& best_memory_variant();

}  // namespace nightjar::esi
