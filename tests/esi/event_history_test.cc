#include "esi/event_history.h"

#include <gtest/gtest.h>

namespace nightjar::esi {
namespace {

std::vector<PackedEvent> events_at(std::uint32_t first_us, std::uint32_t count) {
  std::vector<PackedEvent> events;
  for (std::uint32_t i = 0; i < count; ++i) events.push_back({first_us + i, 2 * i});
  return events;
}

TEST(EventHistory, KeepsTheLatestInOrderAndCountsTheOthers) {
  EventHistory history(/*most_age_us=*/1000000, /*most_events=*/100);
  const auto events = events_at(0, 1050);
  for (std::size_t i = 0; i < events.size(); i += 7)
    history.append(std::span(events).subspan(i, std::min<std::size_t>(7, events.size() - i)));
  ASSERT_EQ(history.events().size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(history.events()[i], events[950 + i]);
  EXPECT_EQ(history.dropped(), 950u);
}

TEST(EventHistory, ForgetsWhatIsTooOldWithoutCountingIt) {
  EventHistory history(/*most_age_us=*/50, /*most_events=*/1000);
  history.append(events_at(0, 200));
  ASSERT_EQ(history.events().size(), 51u);  // that old, too
  EXPECT_EQ(history.events().front().t_us, 149u);
  EXPECT_EQ(history.dropped(), 0u);
}

TEST(EventHistory, TimesMayWrapAround) {
  EventHistory history(/*most_age_us=*/50, /*most_events=*/1000);
  history.append(events_at(0xfffffff0u, 100));
  EXPECT_EQ(history.events().size(), 51u);
}

TEST(EventHistory, DropsTheFirstAndAll) {
  EventHistory history(/*most_age_us=*/1000, /*most_events=*/1000);
  history.append(events_at(0, 10));
  history.drop_first(3);
  EXPECT_EQ(history.events().front().t_us, 3u);
  history.drop_first(7);
  EXPECT_TRUE(history.events().empty());
  history.append(events_at(20, 2));
  history.clear();
  EXPECT_TRUE(history.events().empty());
}

}  // namespace
}  // namespace nightjar::esi
