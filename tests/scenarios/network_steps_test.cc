#include "scenarios/network_steps.h"

#include <gtest/gtest.h>

#include <set>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

/// Unix time, as real cameras stamp: beyond what 32 bits hold.
constexpr core::Time kEpoch{1589163147368868};

TEST(NetworkSteps, end_at_equal_distances_and_at_the_end) {
  const NetworkSteps steps(kEpoch, kEpoch + 95ms, 20);  // 1.9 steps: two of 47.5 ms
  EXPECT_EQ(steps.step_end(kEpoch), kEpoch + 47500us);
  EXPECT_EQ(steps.step_end(kEpoch + 1us), kEpoch + 47500us);
  EXPECT_EQ(steps.step_end(kEpoch + 47500us), kEpoch + 47500us);
  EXPECT_EQ(steps.step_end(kEpoch + 47501us), kEpoch + 95ms);
  EXPECT_EQ(steps.step_end(kEpoch + 95ms), kEpoch + 95ms);
}

TEST(NetworkSteps, are_one_at_least_however_low_the_rate) {
  EXPECT_EQ(NetworkSteps(0us, 40ms, 1).step_end(1us), 40ms);
  EXPECT_EQ(NetworkSteps(7us, 7us, 100).step_end(7us), 7us);
}

TEST(NetworkSteps, of_uneven_microseconds_hold_each_event_once) {
  const NetworkSteps steps(kEpoch, kEpoch + 100us, 70000);  // seven of 14.29 us
  std::set<core::Time> ends;
  for (core::Time t = kEpoch; t <= kEpoch + 100us; ++t) {
    const core::Time end = steps.step_end(t);
    EXPECT_GE(end, t);
    EXPECT_EQ(steps.step_end(end), end);
    EXPECT_LE((end - t).count(), 15);  // the longest, for ends are rounded
    ends.insert(end);
  }
  EXPECT_EQ(ends.size(), 7u);
  EXPECT_EQ(*ends.rbegin(), kEpoch + 100us);
}

}  // namespace
}  // namespace nightjar::scenarios
