#include "sim/background_activity_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/events.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;

BackgroundActivityConfig on(int window_us) { return {.enabled = true, .window_us = window_us}; }

Event event(int t_us, int x, int y) {
  return {Time(t_us), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), true};
}

TEST(BackgroundActivityFilter, passes_only_what_a_neighbour_announced) {
  BackgroundActivityFilter filter(on(2'000), {10, 10});
  std::vector<Event> events{
      event(100, 5, 5),    // alone
      event(200, 5, 5),    // a pixel is no neighbour of itself
      event(2'200, 6, 6),  // just within the window
      event(4'201, 5, 6),  // just outside it
      event(4'300, 3, 6),  // two pixels from (5, 6)
      event(4'400, 4, 5),  // between both
  };
  filter.filter(events);
  EXPECT_EQ(events, (std::vector{event(2'200, 6, 6), event(4'400, 4, 5)}));
  EXPECT_EQ(filter.dropped(), 4u);
}

TEST(BackgroundActivityFilter, all_eight_neighbours_count_at_the_rim_too) {
  for (const auto& [x, y] : {std::pair{0, 0}, {9, 0}, {0, 9}, {9, 9}, {4, 4}})
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const bool inside = x + dx >= 0 && x + dx < 10 && y + dy >= 0 && y + dy < 10;
        if ((dx == 0 && dy == 0) || !inside) continue;
        BackgroundActivityFilter filter(on(1'000), {10, 10});
        std::vector<Event> events{event(10, x + dx, y + dy), event(20, x, y)};
        filter.filter(events);
        EXPECT_EQ(events, std::vector{event(20, x, y)});
      }
}

TEST(BackgroundActivityFilter, remembers_from_call_to_call_and_opposite_rims_are_apart) {
  BackgroundActivityFilter filter(on(1'000), {10, 10});
  std::vector<Event> first{event(10, 9, 3)};
  std::vector<Event> second{event(20, 0, 4), event(30, 8, 4)};
  filter.filter(first);
  filter.filter(second);
  EXPECT_TRUE(first.empty());
  EXPECT_EQ(second, std::vector{event(30, 8, 4)});
}

TEST(BackgroundActivityFilter, uncorrelated_noise_passes_by_chance_alone) {
  // 1 Hz a pixel: some neighbour within 2 ms has the chance 1 - exp(-8 * 0.002).
  const core::Resolution size{100, 100};
  std::vector<Event> events = test::random_events(size, 20'000, Time(2'000'000), 1);
  const auto n = static_cast<double>(events.size());
  BackgroundActivityFilter filter(on(2'000), size);
  filter.filter(events);
  const double chance = 1 - std::exp(-n / 2 / size.pixels() * 8 * 0.002);
  // Rim pixels (4 %) have 5 neighbours: at most 2 % fewer.
  EXPECT_NEAR(static_cast<double>(events.size()), n * chance,
              5 * std::sqrt(n * chance) + 0.02 * n * chance);
}

TEST(BackgroundActivityFilter, switched_off_it_passes_everything) {
  BackgroundActivityFilter filter({}, {10, 10});
  std::vector<Event> events{event(1, 1, 1), event(2, 8, 8)};
  filter.filter(events);
  EXPECT_EQ(events.size(), 2u);
  EXPECT_EQ(filter.dropped(), 0u);
}

}  // namespace
}  // namespace nightjar::sim
