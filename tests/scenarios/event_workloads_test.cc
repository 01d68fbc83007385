#include "scenarios/event_workloads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

void expect_sound(const EventWorkload& w) {
  EXPECT_TRUE(std::ranges::is_sorted(w.events, {}, &esi::PackedEvent::t_us));
  for (const esi::PackedEvent& e : w.events)
    ASSERT_LT(e.pixel(), static_cast<std::uint32_t>(w.size.pixels()));
  ASSERT_FALSE(w.packet_ends.empty());
  EXPECT_EQ(w.packet_ends.back(), w.events.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < w.packet_ends.size(); ++i) {
    const auto end_us = static_cast<std::uint32_t>(EventWorkload::kPacket.count() * (i + 1));
    for (; begin < w.packet_ends[i]; ++begin) {
      ASSERT_LE(w.events[begin].t_us, end_us);
      ASSERT_TRUE(i == 0 || w.events[begin].t_us > end_us - 10'000);
    }
  }
}

TEST(EventWorkloadsTest, all_six_are_sound_and_have_their_rate) {
  const double rates_hz[] = {1e6, 5e6, 12e6};
  for (std::size_t i = 0; i < kWorkloads; ++i) {
    const EventWorkload w = make_workload(i, 100'000);
    expect_sound(w);
    // Intervals are uniform from 0 to twice the mean: 5 sigma of a mean of 100,000 are 0.9 %.
    EXPECT_NEAR(1e11 / w.events.back().t_us, rates_hz[i % 3], 0.01 * rates_hz[i % 3]) << w.name;
    EXPECT_EQ(w.frames.size(), w.events.back().t_us / 40'000) << w.name;
  }
}

TEST(EventWorkloadsTest, the_same_seed_gives_the_same_events) {
  const auto make = [](std::uint64_t seed) {
    return make_workload(EventPattern::moving_edges, 1e6, 1000, seed).events;
  };
  EXPECT_EQ(make(3), make(3));
  EXPECT_NE(make(3), make(4));
}

TEST(EventWorkloadsTest, edges_are_where_few_pixels_are) {
  // 10 ms at 1 Mev/s: eight edges of 260 rows, 2 px and what they move (1 px) wide.
  const auto pixels = [](EventPattern pattern) {
    std::vector<std::uint32_t> seen;
    for (const esi::PackedEvent& e : make_workload(pattern, 1e6, 10'000, 5).events)
      seen.push_back(e.pixel());
    std::ranges::sort(seen);
    return std::unique(seen.begin(), seen.end()) - seen.begin();
  };
  EXPECT_LE(pixels(EventPattern::moving_edges), 8 * 260 * 4);
  EXPECT_GT(pixels(EventPattern::uniform), 9'000);
}

TEST(EventWorkloadsTest, a_recording_begins_at_0) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "events.txt") << "1700000000.5 1 2 1\n1700000000.512 3 0 0\n";
  const auto recording = camera::open_recording(folder / "events.txt");
  const EventWorkload w = read_workload(*recording, "events.txt", 1000);
  expect_sound(w);
  EXPECT_EQ(w.size, (core::Resolution{4, 3}));
  EXPECT_EQ(w.events, (std::vector<esi::PackedEvent>{{0, 2 * 9 + 1}, {12'000, 2 * 3}}));
  EXPECT_EQ(w.packet_ends, (std::vector<std::size_t>{1, 2}));
}

TEST(EventWorkloadsTest, of_a_long_recording_the_first_events_are_taken) {
  const test::ScratchFolder folder;
  std::ofstream file(folder / "events.txt");
  for (int i = 0; i < 100; ++i) file << "0.0" << i + 10 << " 1 1 1\n";
  file.close();
  const auto recording = camera::open_recording(folder / "events.txt");
  EXPECT_EQ(read_workload(*recording, "events.txt", 7).events.size(), 7u);
}

TEST(EventWorkloadsTest, refuses_a_recording_without_events) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "events.txt") << "# nothing\n";
  const auto read = [&] {
    const auto recording = camera::open_recording(folder / "events.txt", core::Resolution{4, 4});
    return read_workload(*recording, "events.txt", 1000);
  };
  EXPECT_THROW(read(), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
