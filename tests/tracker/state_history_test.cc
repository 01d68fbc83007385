#include "tracker/state_history.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::tracker {
namespace {

using core::Time;
using std::chrono::milliseconds;

/// Moving along x at 1 m/s and turning about z at 2 rad/s.
core::VehicleState state_at(Time t) {
  const double s = core::seconds(t);
  return {.t = t,
          .p_world_body_m = {s, 0, 1},
          .v_world_body_m_s = {1, 0, 0},
          .q_world_body = Eigen::Quaterniond(Eigen::AngleAxisd(2 * s, Eigen::Vector3d::UnitZ())),
          .omega_body_rad_s = {0, 0, 2}};
}

void expect_same(const core::VehicleState& a, const core::VehicleState& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_LT((a.p_world_body_m - b.p_world_body_m).norm(), 1e-12);  // rounding
  EXPECT_LT(a.q_world_body.angularDistance(b.q_world_body), 1e-7);
}

TEST(StateHistory, KnowsNothingBeforeTheFirstState) {
  StateHistory history{milliseconds(200), milliseconds(100)};
  EXPECT_FALSE(history.at(Time{}));
  history.add(state_at(milliseconds(10)));
  EXPECT_FALSE(history.at(milliseconds(9)));
  EXPECT_TRUE(history.at(milliseconds(10)));
}

TEST(StateHistory, InterpolatesBetweenStates) {
  StateHistory history{milliseconds(200), milliseconds(100)};
  for (int ms = 0; ms <= 100; ms += 10) history.add(state_at(milliseconds(ms)));
  for (const int ms : {0, 3, 10, 57, 99, 100})
    expect_same(*history.at(milliseconds(ms)), state_at(milliseconds(ms)));
}

TEST(StateHistory, ExtrapolatesAfterTheNewestForAsLongAsItMay) {
  StateHistory history{milliseconds(200), milliseconds(100)};
  history.add(state_at(milliseconds(100)));
  expect_same(*history.at(milliseconds(112)), state_at(milliseconds(112)));
  EXPECT_TRUE(history.at(milliseconds(200)));
  EXPECT_FALSE(history.at(milliseconds(201)));
}

TEST(StateHistory, ForgetsWhatIsOlderThanItsSpan) {
  StateHistory history{milliseconds(200), milliseconds(100)};
  for (int ms = 0; ms <= 1000; ms += 10) history.add(state_at(milliseconds(ms)));
  EXPECT_FALSE(history.at(milliseconds(799)));
  EXPECT_TRUE(history.at(milliseconds(800)));
}

TEST(StateHistory, RefusesAStateThatIsNotNewer) {
  StateHistory history{milliseconds(200), milliseconds(100)};
  history.add(state_at(milliseconds(10)));
  EXPECT_THROW(history.add(state_at(milliseconds(10))), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::tracker
