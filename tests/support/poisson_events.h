#pragma once

#include <cstdint>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/random.h"

namespace nightjar::test {

/// Poisson noise over (0, duration], ordered by time: pixel (x, y) fires
/// `rates_hz(x, y)` times a second, `on_share` of it ON. Rates up to `most_hz`.
inline std::vector<core::Event> poisson_events(const core::Image<double>& rates_hz, double most_hz,
                                               double on_share, core::Time duration,
                                               std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "test.poisson");
  const auto size = rates_hz.size();
  std::vector<core::Event> events;
  const double gap_us = 1e6 / (most_hz * size.pixels());
  for (double t_us = gap_us * core::exponential(random);
       t_us < static_cast<double>(duration.count()); t_us += gap_us * core::exponential(random)) {
    const auto x = static_cast<std::uint16_t>(random() % size.width_px);
    const auto y = static_cast<std::uint16_t>(random() % size.height_px);
    if (core::uniform01(random) * most_hz >= rates_hz(x, y)) continue;  // thinning
    events.push_back({core::Time(static_cast<std::int64_t>(t_us) + 1), x, y,
                      core::uniform01(random) < on_share});
  }
  return events;
}

}  // namespace nightjar::test
