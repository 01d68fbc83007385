#include "scenarios/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

Summary some_run() {
  Summary s;
  s.scenario = "tracking_landing";
  s.seed = 18446744073709551615u;
  s.sim_time_s = 40;
  s.wall_time_s = 80;
  s.real_time_factor = 0.5;
  s.pictures = 4000;
  s.detections = 3000;
  s.detection_rate = 0.75;
  s.false_detections = 2;
  s.straight = {1000, 900};
  s.turning = {2000, 1300};
  s.landing = {1000, 800};
  s.events = 12'000'000;
  s.event_rate_hz = 300'000;
  s.max_readout_delay_us = 950;
  s.bad_radiance = 3;
  s.renders = 16000;
  s.renders_late = 7;
  s.landed = true;
  s.touchdown_error_m = 0.0625;
  s.relative_position_rmse_m = 0.03125;
  s.transitions = {
      {1500ms, core::MissionPhase::search, core::MissionPhase::track, "tag \"0\" seen"}};
  s.estimates_sha256 = "abc";
  s.failed_criteria = {"false_detections = 2, wanted at most 0"};
  s.profile = {{"draw", "drawing", 40s, 16000}, {"wait", "loop", {}, 0}};
  return s;
}

TEST(SummaryJson, HoldsEveryFigureUnderItsName) {
  const auto json = nlohmann::json::parse(to_json(some_run()));
  EXPECT_EQ(json, nlohmann::json::parse(R"({
    "scenario": "tracking_landing", "seed": 18446744073709551615,
    "sim_time_s": 40.0, "wall_time_s": 80.0, "real_time_factor": 0.5,
    "pictures": 4000, "detections": 3000, "detection_rate": 0.75, "false_detections": 2,
    "phases": {"straight": {"pictures": 1000, "detections": 900},
               "turning": {"pictures": 2000, "detections": 1300},
               "landing": {"pictures": 1000, "detections": 800}},
    "events": 12000000, "events_lost": 0, "event_rate_hz": 300000.0,
    "max_readout_delay_us": 950, "bad_radiance": 3, "renders": 16000, "renders_late": 7,
    "landed": true, "crashed": false, "ugv_collided": false,
    "touchdown_error_m": 0.0625, "relative_position_rmse_m": 0.03125,
    "transitions": [{"time_s": 1.5, "from": "search", "to": "track", "cause": "tag \"0\" seen"}],
    "estimates_sha256": "abc", "passed": false,
    "failed_criteria": ["false_detections = 2, wanted at most 0"],
    "profile": [{"stage": "draw", "thread": "drawing", "wall_s": 40.0, "calls": 16000},
                {"stage": "wait", "thread": "loop", "wall_s": 0.0, "calls": 0}]})"));
}

TEST(SummaryJson, WritesNullForWhatThereIsNot) {
  const auto json = nlohmann::json::parse(to_json(Summary{}));
  EXPECT_TRUE(json.at("touchdown_error_m").is_null());
  EXPECT_TRUE(json.at("relative_position_rmse_m").is_null());
  EXPECT_TRUE(json.at("transitions").is_array());
  EXPECT_TRUE(json.at("failed_criteria").is_array());
}

TEST(SummaryTable, ShowsTheFiguresAndWhatWasMissed) {
  const std::string table = to_table(some_run());
  for (const char* text :
       {"tracking_landing, seed 18446744073709551615", "3000 of 4000 pictures (75.0 %), 2 false",
        "1300 of 2000 pictures", "40.0 s in 80.0 s (0.50 x real time)",
        "12000000 (300 k/s), 0 lost, read out after 950 us at most", "0.062 m",
        "1.50 s  search -> track: tag \"0\" seen", "false_detections = 2, wanted at most 0"})
    EXPECT_THAT(table, HasSubstr(text));
  EXPECT_THAT(table, Not(HasSubstr("crashed")));
}

TEST(SummaryTable, ShowsADashForWhatThereIsNot) {
  EXPECT_THAT(to_table(Summary{}), HasSubstr("touchdown error           -\n"));
}

TEST(ProfileTable, ShowsTotalMeanAndShareOfEachStage) {
  const std::string table = profile_table(some_run());
  EXPECT_THAT(table, testing::ContainsRegex("drawing +draw +16000 +40.00 +2.500 +50.0\n"));
  EXPECT_THAT(table, testing::ContainsRegex("loop +wait +0 +0.00 +0.000 +0.0\n"));
}

}  // namespace
}  // namespace nightjar::scenarios
