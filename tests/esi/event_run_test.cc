#include "esi/event_run.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/image.h"
#include "esi/esi.h"
#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kEnd = 20;

std::vector<PackedEvent> hundred() {
  std::vector<PackedEvent> events;
  for (std::uint32_t i = 0; i < 100; ++i) events.push_back({1000 + 10 * i, i % kEnd});
  return events;
}

/// How many events come out in blocks of 16.
std::size_t handed_out(const std::vector<PackedEvent>& events, std::uint32_t begin_us = 1000,
                       std::uint32_t most_us = 10000) {
  EventRun run(events, begin_us, most_us, kEnd);
  std::size_t count = 0;
  for (auto block = run.next(16); !block.empty(); block = run.next(16)) {
    EXPECT_EQ(block.data(), events.data() + count);
    count += block.size();
  }
  EXPECT_EQ(run.rest().size(), events.size() - count);
  return count;
}

TEST(EventRun, HandsOutAllInOrder) { EXPECT_EQ(handed_out(hundred()), 100u); }

TEST(EventRun, OfNoEventsHandsOutNone) { EXPECT_EQ(handed_out({}), 0u); }

TEST(EventRun, StopsBeforeTheBlockWithSomethingAmiss) {
  for (const std::size_t place : {0, 1, 15, 16, 17, 31, 32, 99}) {
    const std::size_t before = place / 16 * 16;
    auto outside = hundred();
    outside[place].pixel_on = kEnd;
    EXPECT_EQ(handed_out(outside), before) << place;
    auto backwards = hundred();
    backwards[place].t_us = place > 0 ? backwards[place - 1].t_us - 1 : 999;
    EXPECT_EQ(handed_out(backwards), before) << place;
    auto wraps = hundred();  // ends beyond 2^32 from here on
    for (std::size_t i = place; i < wraps.size(); ++i)
      wraps[i].t_us -= 1000 + 10 * static_cast<std::uint32_t>(place);
    EXPECT_EQ(handed_out(wraps), before) << place;
  }
}

TEST(EventRun, StopsBeforeTheBlockThatEndsTooLate) {
  // Event i is 10 i us after the begin; block 2 ends with event 47.
  EXPECT_EQ(handed_out(hundred(), 1000, 471), 48u);
  EXPECT_EQ(handed_out(hundred(), 1000, 470), 32u);
  EXPECT_EQ(handed_out(hundred(), 1000, 0), 0u);
}

TEST(EventRun, GoesOnBehindWhatAMethodHasTakenItself) {
  const auto events = hundred();
  EventRun run(events, 1000, 10000, kEnd);
  ASSERT_NE(run.limits(), nullptr);
  EXPECT_EQ(run.limits()->pixel_on_end, kEnd);
  run.take(3);
  EXPECT_EQ(run.limits()->earliest_us, events[2].t_us);
  EXPECT_EQ(run.next(1).data(), &events[3]);
  EXPECT_EQ(run.rest().size(), 96u);
  EXPECT_EQ(EventRun(events).limits(), nullptr);
}

TEST(EventRun, HandsOutWhatWasCheckedAsItIs) {
  const std::vector<PackedEvent> any = {{5, 1000}, {3, 7}};
  EventRun run(any);
  EXPECT_EQ(run.next(1).size(), 1u);
  EXPECT_EQ(run.next(9).size(), 1u);
  EXPECT_TRUE(run.next(9).empty());
}

TEST(EventRun, AMethodThatTakesBlocksItselfKeepsWhatCameBeforeABadEvent) {
  constexpr core::Resolution kSensor{16, 12};
  const auto events = test::random_events(kSensor, 300, 300ms, /*seed=*/11);
  std::vector<PackedEvent> good;
  for (const core::Event& e : events) good.push_back(pack(e, kSensor.width_px));
  const auto keeps_those_before = [&](const std::vector<PackedEvent>& bad, std::size_t place) {
    Esi refusing({}, kSensor), expected({}, kSensor);
    EXPECT_THROW(refusing.process(std::span<const PackedEvent>(bad)), std::invalid_argument);
    expected.process(std::span<const PackedEvent>(good).first(place));
    core::Picture a, b;
    refusing.render(300ms, a);
    expected.render(300ms, b);
    EXPECT_EQ(a.gray, b.gray) << place;
    // And goes on from there.
    EXPECT_NO_THROW(refusing.process(std::span<const PackedEvent>(good).subspan(place)));
  };
  for (const std::size_t place : {0, 1, 15, 16, 17, 63, 64, 65, 127, 128, 299}) {
    auto bad = good;
    bad[place].pixel_on = 2 * 16 * 12;
    keeps_those_before(bad, place);
    if (place == 0) continue;
    bad = good;
    bad[place].t_us = bad[place - 1].t_us - 1;
    keeps_those_before(bad, place);
  }
}

TEST(EventRun, AMethodThatTakesBlocksItselfStopsWhereAgesHaveToBeLimited) {
  // A minute apart, and after an hour at the first one's pixel again: counted in 32 bits with
  // a sign, that age is negative.
  constexpr core::Resolution kSensor{16, 12};
  EsiConfig config;
  config.decay_rate_hz = 1e-4;
  std::vector<PackedEvent> events;
  for (std::uint32_t i = 0; i < 60; ++i) events.push_back({60'000'000 * i, 2 * (i % 59) + 1});
  events.push_back(events.back());  // so that the one before is not among the last of the run
  events.back().pixel_on = 2 * 100;
  Esi at_once(config, kSensor), one_by_one(config, kSensor);
  at_once.process(std::span<const PackedEvent>(events));
  for (const PackedEvent& e : events) one_by_one.process(std::span<const PackedEvent>(&e, 1));
  core::Picture a, b;
  at_once.render(1h, a);
  one_by_one.render(1h, b);
  EXPECT_EQ(a.gray, b.gray);
}

}  // namespace
}  // namespace nightjar::esi
