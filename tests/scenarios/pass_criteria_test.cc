#include "scenarios/pass_criteria.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/config_check.h"

namespace nightjar::scenarios {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Summary good_run() {
  Summary s;
  s.landed = true;
  s.touchdown_error_m = 0.05;
  s.detection_rate = 0.8;
  s.relative_position_rmse_m = 0.02;
  return s;
}

TEST(PassCriteria, DefaultsAreWithinTheirRanges) {
  EXPECT_NO_THROW(core::check_config(PassCriteria{}, "pass"));
}

TEST(PassCriteria, AGoodRunMissesNothing) {
  EXPECT_THAT(failed_criteria({}, good_run()), IsEmpty());
}

TEST(PassCriteria, FiguresExactlyAtTheirLimitsPass) {
  Summary s = good_run();
  s.touchdown_error_m = 0.10;
  s.detection_rate = 0.74;
  s.false_detections = 3;
  s.relative_position_rmse_m = 0.25;
  EXPECT_THAT(failed_criteria({.max_false_detections = 3, .max_relative_position_rmse_m = 0.25}, s),
              IsEmpty());
}

TEST(PassCriteria, EveryFigureMissedIsNamedWithWhatWasWanted) {
  Summary s = good_run();
  s.touchdown_error_m = 0.2;
  s.detection_rate = 0.61;
  s.false_detections = 4;
  s.relative_position_rmse_m = 1.5;
  s.crashed = true;
  s.ugv_collided = true;
  EXPECT_THAT(failed_criteria({}, s),
              ElementsAre("crashed = true, wanted false", "ugv_collided = true, wanted false",
                          "touchdown_error_m = 0.2, wanted at most 0.1",
                          "detection_rate = 0.61, wanted at least 0.74",
                          "false_detections = 4, wanted at most 0",
                          "relative_position_rmse_m = 1.5, wanted at most 0.5"));
}

TEST(PassCriteria, LandingIsJudgedOnlyWhereItIsWanted) {
  Summary s = good_run();
  s.landed = false;
  s.touchdown_error_m.reset();
  EXPECT_THAT(failed_criteria({}, s), ElementsAre("landed = false, wanted true"));
  EXPECT_THAT(failed_criteria({.require_landed = false}, s), IsEmpty());
}

TEST(PassCriteria, FiguresThatAreMissingOrNoNumbersFail) {
  Summary s = good_run();
  s.relative_position_rmse_m.reset();
  s.detection_rate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(failed_criteria({}, s),
              ElementsAre("detection_rate = nan, wanted at least 0.74",
                          "relative_position_rmse_m = none, wanted at most 0.5"));
}

}  // namespace
}  // namespace nightjar::scenarios
