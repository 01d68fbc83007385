#pragma once

#include <vector>

#include "core/event.h"
#include "core/random.h"

namespace nightjar::test {

/// `n` events spread evenly at random over the sensor and (0, duration], ordered by time.
inline std::vector<core::Event> random_events(core::Resolution size, int n, core::Time duration,
                                              std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "test.events");
  std::vector<core::Event> events;
  core::Time t{};
  for (int i = 0; i < n; ++i) {
    t += core::Time(1 + static_cast<std::int64_t>(2.0 * core::uniform01(random) *
                                                  static_cast<double>(duration.count() / n - 1)));
    if (t > duration) break;
    events.push_back({t, static_cast<std::uint16_t>(random() % size.width_px),
                      static_cast<std::uint16_t>(random() % size.height_px), random() % 2 == 0});
  }
  return events;
}

}  // namespace nightjar::test
