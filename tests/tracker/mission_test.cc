#include "tracker/mission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace nightjar::tracker {
namespace {

using core::MissionPhase;
using testing::HasSubstr;

/// A vehicle that flies exactly what it is told, over a target at the origin
/// that heads along y; the test says when the tag is seen.
class Flight {
 public:
  explicit Flight(const MissionConfig& config = quick()) : mission(config) {
    vehicle.p_world_body_m = {0.5, 0, 1};
  }

  static MissionConfig quick() {
    MissionConfig config;
    config.land_after_s = 2;
    return config;
  }

  /// Pictures of 10 ms until `seconds` have passed or the phase has changed.
  void fly(double seconds) {
    const MissionPhase before = mission.phase();
    for (int i = 0; i < static_cast<int>(seconds * 100) && mission.phase() == before; ++i) step();
  }

  void step() {
    vehicle.t += std::chrono::milliseconds(10);
    target.t = vehicle.t;
    if (tag_seen) {
      target.valid = true;
      target.last_tag = vehicle.t;
    }
    goal = mission.step(vehicle, target);
    for (auto& transition : mission.take_transitions()) log.push_back(transition);
    if (!goal.motors_on) return;
    Eigen::Vector3d p = goal.p_world_m + aside_m;
    if (on_board) p.z() = std::max(p.z(), MissionConfig{}.stand_height_m);
    vehicle.v_world_body_m_s = (p - vehicle.p_world_body_m) / 0.01;
    vehicle.p_world_body_m = p;
  }

  /// Flies on, all going well, until this phase; fails if it does not come.
  void reach(MissionPhase phase) {
    tag_seen = true;
    for (int i = 0; i < 3000 && mission.phase() != phase; ++i) step();
    ASSERT_EQ(mission.phase(), phase);
  }

  Mission mission;
  core::VehicleState vehicle;
  core::TargetEstimate target;
  FlightGoal goal;
  bool tag_seen = false;
  bool on_board = true;  // the board stops the descent
  Eigen::Vector3d aside_m = Eigen::Vector3d::Zero();
  std::vector<core::MissionTransition> log;
};

TEST(Mission, GoesThroughAllPhasesInOrderAndSaysWhy) {
  Flight flight;
  flight.fly(0.5);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::search);
  flight.reach(MissionPhase::touched_down);
  const std::vector<MissionPhase> expected{MissionPhase::track, MissionPhase::descend,
                                           MissionPhase::land, MissionPhase::touched_down};
  const std::vector<const char*> causes{"tag found", "landing allowed", "committed",
                                        "told to descend"};
  ASSERT_EQ(flight.log.size(), 4u);
  MissionPhase from = MissionPhase::search;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(flight.log[i].from, from);
    EXPECT_EQ(flight.log[i].to, expected[i]);
    EXPECT_THAT(flight.log[i].cause, HasSubstr(causes[i]));
    EXPECT_THAT(flight.log[i].cause, testing::ContainsRegex("[0-9]"));
    from = expected[i];
  }
  EXPECT_FALSE(flight.goal.motors_on);
}

TEST(Mission, StaysDownOnceTouchedDown) {
  Flight flight;
  flight.reach(MissionPhase::touched_down);
  flight.fly(10);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::touched_down);
  EXPECT_FALSE(flight.goal.motors_on);
}

TEST(Mission, TracksAtItsHeightUntilLandingIsAllowed) {
  MissionConfig config;
  config.land_after_s = 20;
  Flight flight(config);
  flight.reach(MissionPhase::track);
  flight.fly(10);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::track);
  EXPECT_NEAR(flight.goal.p_world_m.z(), config.track_height_m, 0.01);
  flight.fly(11);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::descend);
}

TEST(Mission, FollowsTheTargetsMotionAndHeading) {
  Flight flight;
  flight.target.v_world_tag_m_s = {0, 0.5, 0};
  flight.target.heading_rad = 1.57;
  flight.target.turn_rate_rad_s = 0.4;
  flight.reach(MissionPhase::track);
  flight.step();
  EXPECT_DOUBLE_EQ(flight.goal.v_world_m_s.y(), 0.5);
  EXPECT_DOUBLE_EQ(flight.goal.a_world_m_s2.x(), -0.4 * 0.5);  // towards the turn's centre
  EXPECT_DOUBLE_EQ(flight.goal.heading_rad.value(), 1.57);
}

struct Loss {
  MissionPhase phase;
  bool gives_up;
};

class MissionLosesTheTag : public testing::TestWithParam<Loss> {};

TEST_P(MissionLosesTheTag, CoastsThenSearchesOrLandsOnThePrediction) {
  Flight flight;
  flight.reach(GetParam().phase);
  flight.tag_seen = false;
  flight.fly(MissionConfig{}.lost_after_s - 0.1);
  EXPECT_NE(flight.mission.phase(), MissionPhase::search) << "still coasting";
  flight.fly(0.2);
  EXPECT_EQ(flight.mission.phase() == MissionPhase::search, GetParam().gives_up);
  if (GetParam().gives_up) {
    EXPECT_THAT(flight.log.back().cause, HasSubstr("no tag for 1.5"));
    return;
  }
  flight.fly(3);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::touched_down);
}

INSTANTIATE_TEST_SUITE_P(InEachPhase, MissionLosesTheTag,
                         testing::Values(Loss{MissionPhase::track, true},
                                         Loss{MissionPhase::descend, true},
                                         Loss{MissionPhase::land, false}),
                         [](const auto& loss) { return to_string(loss.param.phase); });

class MissionLosesTheEstimate : public testing::TestWithParam<MissionPhase> {};

TEST_P(MissionLosesTheEstimate, SearchesAtOnce) {
  Flight flight;
  flight.reach(GetParam());
  flight.tag_seen = false;
  flight.target.valid = false;
  flight.step();
  EXPECT_EQ(flight.mission.phase(), MissionPhase::search);
  EXPECT_EQ(flight.log.back().from, GetParam());
}

INSTANTIATE_TEST_SUITE_P(InEachPhase, MissionLosesTheEstimate,
                         testing::Values(MissionPhase::track, MissionPhase::descend,
                                         MissionPhase::land),
                         [](const auto& phase) { return to_string(phase.param); });

TEST(Mission, ClimbsSlowlyAndSpiralsAroundTheLastTagWhenSearching) {
  Flight flight;
  flight.reach(MissionPhase::descend);
  flight.fly(1);
  flight.tag_seen = false;
  flight.fly(2);
  ASSERT_EQ(flight.mission.phase(), MissionPhase::search);
  const double start_z_m = flight.goal.p_world_m.z();
  flight.target.valid = false;
  const MissionConfig config;
  double farthest_m = 0, z_m = start_z_m;
  for (int i = 0; i < 6000; ++i) {
    flight.step();
    // One picture's climb; the rounding of 6000 sums.
    EXPECT_LE(std::abs(flight.goal.p_world_m.z() - z_m), config.climb_speed_m_s * 0.01 + 1e-9);
    z_m = flight.goal.p_world_m.z();
    const double radius_m = flight.goal.p_world_m.head<2>().norm();
    if (i < 250) {
      EXPECT_LT(radius_m, 1e-9) << "holds first";
    }
    farthest_m = std::max(farthest_m, radius_m);
  }
  EXPECT_NEAR(z_m, config.search_height_m, 1e-9);
  EXPECT_NEAR(farthest_m, config.search_radius_m, 1.5);  // 30 m of spiral are three rounds
  EXPECT_GT(farthest_m, 1.5);
  EXPECT_FALSE(flight.goal.heading_rad.has_value());
}

TEST(Mission, FindsTheTagAgainAndDescendsFromWhereItIs) {
  Flight flight;
  flight.reach(MissionPhase::descend);
  flight.tag_seen = false;
  flight.fly(4);
  ASSERT_EQ(flight.mission.phase(), MissionPhase::search);
  const double z_m = flight.vehicle.p_world_body_m.z();
  flight.tag_seen = true;
  flight.step();
  EXPECT_EQ(flight.mission.phase(), MissionPhase::track);
  EXPECT_NEAR(flight.goal.p_world_m.z(), z_m, 0.02);  // no jump
  flight.reach(MissionPhase::touched_down);
}

TEST(Mission, HoldsItsHeightOutsideTheCone) {
  Flight flight;
  flight.reach(MissionPhase::descend);
  flight.aside_m = {0.5, 0, 0};
  flight.step();
  const double z_m = flight.goal.p_world_m.z();
  flight.fly(3);
  EXPECT_NEAR(flight.goal.p_world_m.z(), z_m, MissionConfig{}.descend_speed_m_s * 0.011);
  flight.aside_m.setZero();
  flight.fly(1);
  EXPECT_LT(flight.goal.p_world_m.z(), z_m - 0.2);
}

TEST(Mission, DoesNotCommitAsideOfTheTag) {
  Flight flight;
  flight.reach(MissionPhase::descend);
  flight.aside_m = {MissionConfig{}.commit_radius_m + 0.01, 0, 0};  // inside the cone
  flight.fly(10);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::descend);
  EXPECT_GT(flight.goal.p_world_m.z(), 0.9 * MissionConfig{}.commit_height_m);
  flight.aside_m.setZero();
  flight.fly(0.1);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::land);
}

TEST(Mission, DoesNotBeginToDescendWhileMisaligned) {
  Flight flight;
  flight.aside_m = {MissionConfig{}.align_radius_m + 0.01, 0, 0};
  flight.reach(MissionPhase::track);
  flight.fly(5);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::track);
}

TEST(Mission, GivesUpALandingThatFindsNoBoard) {
  Flight flight;
  flight.on_board = false;
  flight.reach(MissionPhase::land);
  flight.aside_m = {0, 0, 0.6};  // hovers above it, whatever it is told
  flight.fly(MissionConfig{}.land_timeout_s - 0.1);
  const double hover_z_m = flight.vehicle.p_world_body_m.z();
  EXPECT_LT(flight.goal.p_world_m.z(), hover_z_m);  // told to come down to the last
  flight.fly(0.2);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::search);
  EXPECT_THAT(flight.log.back().cause, HasSubstr("no touchdown within 3.50 s"));
  EXPECT_GE(flight.goal.p_world_m.z(), hover_z_m);  // and no longer now
}

TEST(Mission, DoesNotTakeSinkingThroughStandingHeightForTouchdown) {
  Flight flight;
  flight.on_board = false;
  flight.reach(MissionPhase::land);
  flight.fly(1.5);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::land);
  EXPECT_LT(flight.vehicle.p_world_body_m.z(), MissionConfig{}.stand_height_m);
}

TEST(Mission, DoesNotTakeHangingBelowItsGoalForTouchdown) {
  Flight flight;
  flight.reach(MissionPhase::land);
  flight.aside_m = {0, 0, -1};  // at standing height at once, the goal still above it
  flight.fly(0.5);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::land);
  flight.fly(1);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::touched_down);
}

TEST(Mission, HoldsWhereItBeganBeforeTheFirstTag) {
  Flight flight;
  flight.fly(1);
  EXPECT_NEAR(flight.goal.p_world_m.x(), 0.5, 1e-12);
  EXPECT_GT(flight.goal.p_world_m.z(), 1.2);
  EXPECT_FALSE(flight.goal.height_above_tag_m.has_value());
}

TEST(Mission, RefusesAConfigOutOfRange) {
  MissionConfig config;
  config.track_height_m = -1;
  EXPECT_THROW(Mission{config}, std::invalid_argument);
}

TEST(Mission, MovesItsGoalLittleAfterPicturesWereAway) {
  Flight flight;
  flight.reach(MissionPhase::descend);
  for (int i = 0; i < 50; ++i) flight.step();
  const double height_m = flight.goal.p_world_m.z();
  flight.vehicle.t += std::chrono::seconds(3);  // somebody else held it there
  flight.step();
  ASSERT_EQ(flight.mission.phase(), MissionPhase::descend);
  // The longest step counted is 0.15 s; 3 s would be 0.75 m.
  EXPECT_NEAR(flight.goal.p_world_m.z(), height_m, 0.15 * MissionConfig{}.descend_speed_m_s + 1e-9);
}

TEST(Mission, CountsNoConditionAsHeldWhilePicturesWereAway) {
  MissionConfig config = Flight::quick();
  config.land_after_s = 0;
  Flight flight(config);
  flight.reach(MissionPhase::track);
  flight.fly(0.3);  // of 0.5 s that alignment must last
  flight.vehicle.t += std::chrono::seconds(3);
  flight.fly(0.45);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::track);
  flight.fly(0.1);
  EXPECT_EQ(flight.mission.phase(), MissionPhase::descend);
}

}  // namespace
}  // namespace nightjar::tracker
