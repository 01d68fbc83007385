#include "sim/bucket_sort.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/random.h"
#include "sim/fired_events.h"

namespace nightjar::sim {
namespace {

TEST(BucketSort, sorts_what_is_spread_and_what_is_not) {
  core::Random random = core::random_stream(1, "sort");
  BucketSort<std::uint64_t> order;
  for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1000},
                                   (std::uint64_t{9'000} << 32) - 1, UINT64_MAX})
    for (const std::size_t count : {0, 1, 2, 17, 3000})
      for (const std::uint64_t within : {most, most / 1000}) {  // spread, or all in few buckets
        std::vector<std::uint64_t> items(count);
        for (std::uint64_t& item : items)
          item = within == UINT64_MAX ? random() : random() % (within + 1);
        std::vector<std::uint64_t> sorted = items;
        std::ranges::sort(sorted);
        order.sort(items, most, std::identity(), std::less());
        EXPECT_EQ(items, sorted) << most << ' ' << count;
      }
}

TEST(FiredEvents, are_handed_over_by_time_then_row_then_column) {
  using core::Event;
  using core::Time;
  FiredEvents fired;
  fired.add(7, 12, true);
  fired.add(2, 13, false);
  fired.add(7, 9, false);
  fired.add(2, 3, true);
  fired.add(2, 2, true);
  std::vector<Event> events{{Time(50), 0, 0, true}};
  fired.hand_over(Time(100), Time(7), 10, events);
  const std::vector<Event> expected{{Time(50), 0, 0, true},   {Time(102), 2, 0, true},
                                    {Time(102), 3, 0, true},  {Time(102), 3, 1, false},
                                    {Time(107), 9, 0, false}, {Time(107), 2, 1, true}};
  EXPECT_EQ(events, expected);
  fired.hand_over(Time(107), Time(7), 10, events);
  EXPECT_EQ(events, expected);  // they are handed over once
}

TEST(FiredEvents, find_row_and_column_of_every_pixel) {
  for (const std::uint32_t width : {1u, 3u, 49u, 346u, 1023u, 32767u}) {
    FiredEvents fired;
    constexpr std::uint32_t kRows = 300;
    for (std::uint32_t y = 0; y < kRows; ++y) {
      fired.add(1, y * width, true);
      if (width > 1) fired.add(1, y * width + width - 1, true);
    }
    std::vector<core::Event> events;
    fired.hand_over(core::Time(0), core::Time(1), static_cast<int>(width), events);
    ASSERT_EQ(events.size(), kRows * (width > 1 ? 2 : 1));
    std::size_t k = 0;
    for (std::uint32_t y = 0; y < kRows; ++y)
      for (const std::uint32_t x : {0u, width - 1}) {
        EXPECT_EQ(events[k], (core::Event{core::Time(1), static_cast<std::uint16_t>(x),
                                          static_cast<std::uint16_t>(y), true}));
        ++k;
        if (width == 1) break;
      }
  }
}

TEST(FiredEvents, steps_of_an_hour_do_not_overflow) {
  FiredEvents fired;
  constexpr std::uint32_t kHourUs = 3'600'000'000;
  fired.add(kHourUs, 0x7fffffff, true);
  fired.add(kHourUs - 1, 5, false);
  std::vector<core::Event> events;
  fired.hand_over(core::Time(0), core::Time(kHourUs), 32767, events);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].t, core::Time(kHourUs));
  EXPECT_EQ(events[1].x, 0x7fffffff % 32767);
}

}  // namespace
}  // namespace nightjar::sim
