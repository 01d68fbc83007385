#include "scenarios/scorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/picture_records.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using core::MissionPhase;
using test::blank_record;
using test::perfect_record;
using testing::ElementsAre;
using testing::HasSubstr;

Scorer scorer() {
  return Scorer({.scenario = "test",
                 .seed = 7,
                 .camera = test::davis_camera(),
                 .tag = {.id = 0, .size_m = test::kTagSize_m},
                 .criteria = {}});
}

/// The UAV on the board, `error_m` east of the tag's centre.
PictureRecord on_board_record(core::Time t, double error_m) {
  PictureRecord record = perfect_record(t);
  record.truth.uav.p_world_body_m.x() += error_m;
  record.vehicle = record.truth.uav;
  record.truth.course_phase = "landing";
  record.truth.on_board = true;
  return record;
}

core::MissionTransition touchdown(core::Time t) {
  return {t, MissionPhase::land, MissionPhase::touched_down, "weight on feet"};
}

TEST(Scorer, CountsDetectionsInTheirPhases) {
  Scorer s = scorer();
  core::Time t{};
  const auto fly = [&](const char* phase, int found, int missed) {
    for (int i = 0; i < found + missed; ++i) {
      PictureRecord record = i < found ? perfect_record(t) : blank_record(t);
      record.truth.course_phase = phase;
      s.add(record);
      t += 10ms;
    }
  };
  fly("straight", 3, 1);
  fly("turning", 1, 2);
  fly("landing", 2, 1);
  const Summary got = s.summary(t, 1.0);
  EXPECT_EQ(got.pictures, 10);
  EXPECT_EQ(got.detections, 6);
  EXPECT_DOUBLE_EQ(got.detection_rate, 0.6);
  EXPECT_EQ(got.straight.pictures, 4);
  EXPECT_EQ(got.straight.detections, 3);
  EXPECT_EQ(got.turning.pictures, 3);
  EXPECT_EQ(got.turning.detections, 1);
  EXPECT_EQ(got.landing.pictures, 3);
  EXPECT_EQ(got.landing.detections, 2);
}

TEST(Scorer, CountsFalseDetectionsAmongRightOnes) {
  Scorer s = scorer();
  PictureRecord record = perfect_record(10ms);
  record.detections.push_back(record.detections[0]);
  record.detections[1].id = 17;
  s.add(record);
  EXPECT_EQ(s.summary(10ms, 1.0).detections, 1);
  EXPECT_EQ(s.summary(10ms, 1.0).false_detections, 1);
}

TEST(Scorer, MakesRatesOfSimulatedTime) {
  Scorer s = scorer();
  s.add_events(3000);
  s.add_events(1000);
  const Summary got = s.summary(2s, 0.5);
  EXPECT_EQ(got.events, 4000);
  EXPECT_DOUBLE_EQ(got.event_rate_hz, 2000);
  EXPECT_DOUBLE_EQ(got.sim_time_s, 2);
  EXPECT_DOUBLE_EQ(got.wall_time_s, 0.5);
  EXPECT_DOUBLE_EQ(got.real_time_factor, 4);
  EXPECT_EQ(got.scenario, "test");
  EXPECT_EQ(got.seed, 7u);
}

TEST(Scorer, ScoresARunWithoutPictures) {
  const Summary got = scorer().summary(0us, 0.0);
  EXPECT_EQ(got.detection_rate, 0);
  EXPECT_EQ(got.event_rate_hz, 0);
  EXPECT_EQ(got.real_time_factor, 0);
  EXPECT_FALSE(got.landed);
  EXPECT_FALSE(got.relative_position_rmse_m);
  EXPECT_FALSE(got.passed);
}

TEST(Scorer, RelativePositionErrorIsRootMeanSquareOverValidEstimates) {
  Scorer s = scorer();
  PictureRecord record = perfect_record(10ms);
  record.estimate.p_world_tag_m += Eigen::Vector3d(0.3, 0, 0.4);  // 0.5 m
  s.add(record);
  s.add(blank_record(20ms));
  s.add(perfect_record(30ms));
  // sqrt((0.25 + 0) / 2); two ulps for the differences of numbers near 3
  EXPECT_NEAR(s.summary(30ms, 1.0).relative_position_rmse_m.value(), 0.3535533905932738, 1e-15);
}

TEST(Scorer, RelativePositionForgivesAnErrorThatUavAndTagShare) {
  Scorer s = scorer();
  PictureRecord record = perfect_record(10ms);
  const Eigen::Vector3d drift_m(5, -3, 1);
  record.vehicle.p_world_body_m += drift_m;
  record.estimate.p_world_tag_m += drift_m;
  s.add(record);
  // a few roundings of numbers near 8
  EXPECT_NEAR(s.summary(10ms, 1.0).relative_position_rmse_m.value(), 0, 1e-14);
}

TEST(Scorer, TouchdownErrorIsHorizontalAndTakenAtTouchdown) {
  Scorer s = scorer();
  s.add(on_board_record(10ms, 0.5));  // feet down, but the mission is not yet sure
  s.add(touchdown(20ms));
  s.add(on_board_record(20ms, 0.03));
  s.add(on_board_record(30ms, 0.07));
  const Summary got = s.summary(30ms, 1.0);
  EXPECT_TRUE(got.landed);
  EXPECT_NEAR(got.touchdown_error_m.value(), 0.03, 1e-15);  // rounding of 3.03 - 3
}

TEST(Scorer, TransitionMayComeBeforeOrAfterItsPicture) {
  Scorer before = scorer();
  before.add(touchdown(20ms));
  before.add(on_board_record(20ms, 0.03));
  before.add(on_board_record(30ms, 0.07));
  Scorer after = scorer();
  after.add(on_board_record(20ms, 0.03));
  after.add(touchdown(20ms));
  after.add(on_board_record(30ms, 0.07));
  EXPECT_EQ(before.summary(30ms, 1.0).touchdown_error_m,
            after.summary(30ms, 1.0).touchdown_error_m);
}

TEST(Scorer, BeingOnTheBoardIsNotLandedUntilTheMissionSaysSo) {
  Scorer s = scorer();
  s.add(on_board_record(10ms, 0.03));
  const Summary got = s.summary(10ms, 1.0);
  EXPECT_FALSE(got.landed);
  EXPECT_FALSE(got.touchdown_error_m);
}

TEST(Scorer, TouchingDownBesideTheBoardIsNotLanded) {
  Scorer s = scorer();
  s.add(touchdown(10ms));
  s.add(perfect_record(10ms));
  EXPECT_FALSE(s.summary(10ms, 1.0).landed);
}

TEST(Scorer, SlidingOffTheBoardIsNotLanded) {
  Scorer s = scorer();
  s.add(touchdown(10ms));
  s.add(on_board_record(10ms, 0.03));
  s.add(perfect_record(20ms));
  const Summary got = s.summary(20ms, 1.0);
  EXPECT_FALSE(got.landed);
  EXPECT_FALSE(got.touchdown_error_m);
}

TEST(Scorer, ACrashIsNeverForgiven) {
  Scorer s = scorer();
  PictureRecord crash = perfect_record(10ms);
  crash.truth.crashed = true;
  s.add(crash);
  s.add(touchdown(20ms));
  s.add(on_board_record(20ms, 0.03));
  const Summary got = s.summary(20ms, 1.0);
  EXPECT_TRUE(got.crashed);
  EXPECT_FALSE(got.landed);
  EXPECT_FALSE(got.passed);
}

TEST(Scorer, PassesAFlawlessRun) {
  Scorer s = scorer();
  s.add(perfect_record(10ms));
  s.add(touchdown(20ms));
  s.add(on_board_record(20ms, 0));
  const Summary got = s.summary(20ms, 1.0);
  EXPECT_THAT(got.failed_criteria, ElementsAre());
  EXPECT_TRUE(got.passed);
}

TEST(Scorer, NamesWhatAFailedRunMissed) {
  Scorer s = scorer();
  s.add(blank_record(10ms));
  EXPECT_THAT(s.summary(10ms, 1.0).failed_criteria,
              ElementsAre("landed = false, wanted true", "detection_rate = 0, wanted at least 0.74",
                          HasSubstr("relative_position_rmse_m = none")));
}

TEST(Scorer, RefusesPartsOfDifferentTimes) {
  PictureRecord record = perfect_record(10ms);
  record.vehicle.t = 11ms;
  EXPECT_THROW(scorer().add(record), std::invalid_argument);
  record = perfect_record(10ms);
  record.estimate.t = 11ms;
  EXPECT_THROW(scorer().add(record), std::invalid_argument);
  record = perfect_record(10ms);
  record.detections[0].t = 11ms;
  EXPECT_THROW(scorer().add(record), std::invalid_argument);
  record = blank_record(10ms);
  record.estimate.t = 0us;  // nothing to compare
  EXPECT_NO_THROW(scorer().add(record));
}

TEST(Scorer, RefusesPicturesThatGoBackInTime) {
  Scorer s = scorer();
  s.add(blank_record(20ms));
  EXPECT_THROW(s.add(blank_record(10ms)), std::invalid_argument);
}

TEST(Scorer, RefusesAPhaseItDoesNotKnow) {
  PictureRecord record = blank_record(10ms);
  record.truth.course_phase = "reversing";
  EXPECT_THROW(scorer().add(record), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
