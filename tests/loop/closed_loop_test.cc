// Short closed loops, judged on truth and on what they leave behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

#include "msg/channels.h"
#include "scenarios/loop.h"
#include "scenarios/output_folder.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::Contains;
using testing::Not;

Scenario smoke(double duration_s) {
  Scenario scenario = load(std::string(NIGHTJAR_SOURCE_DIR) + "/scenarios/smoke.yaml");
  scenario.duration_s = duration_s;
  return scenario;
}

class ClosedLoop : public testing::Test {
 protected:
  RunOptions options(const std::string& folder) const {
    RunOptions options;
    options.out = scratch_.path() / folder;
    options.video = false;
    return options;
  }

  /// Messages in a run's log, by channel.
  std::map<std::string, int> logged(const std::string& folder) const {
    std::map<std::string, int> count;
    lcm::LogFile log((scratch_.path() / folder / kLogFile).string(), "r");
    while (const lcm::LogEvent* event = log.readNextEvent()) ++count[event->channel];
    return count;
  }

  test::ScratchFolder scratch_;
};

TEST_F(ClosedLoop, SmokeScenarioFindsTheTagFollowsAndLands) {
  const Summary summary = run(smoke(12), options("a"));
  EXPECT_TRUE(summary.passed) << testing::PrintToString(summary.failed_criteria);
  EXPECT_TRUE(summary.landed);
  ASSERT_TRUE(summary.touchdown_error_m);
  EXPECT_LE(*summary.touchdown_error_m, 0.10);  // what the scenario asks for
  std::vector<core::MissionPhase> phases;
  for (const auto& transition : summary.transitions) {
    EXPECT_FALSE(transition.cause.empty());
    phases.push_back(transition.to);
  }
  using enum core::MissionPhase;
  EXPECT_THAT(phases, testing::ElementsAre(track, descend, land, touched_down));

  std::ifstream file(scratch_.path() / "a" / kSummaryFile);
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["pictures"].get<std::int64_t>(), summary.pictures);
  EXPECT_EQ(json["estimates_sha256"].get<std::string>(), summary.estimates_sha256);
  EXPECT_EQ(summary.pictures, std::lround(summary.sim_time_s * 100));  // one a packet of 10 ms
  // Just above the board all pixels ask at once: a full queue takes 1 ms to read.
  EXPECT_GT(summary.events_lost, 0);
  EXPECT_GE(summary.max_readout_delay_us, 990);
}

TEST_F(ClosedLoop, OneSeedHasOneResultAndAnotherSeedAnother) {
  Scenario scenario = smoke(1.0);
  const Summary a = run(scenario, options("a"));
  const Summary b = run(scenario, options("b"));
  scenario.seed = 2;
  const Summary c = run(scenario, options("c"));
  EXPECT_GT(a.detections, 0);  // else all estimates would be alike for want of any
  EXPECT_EQ(a.estimates_sha256, b.estimates_sha256);
  EXPECT_NE(a.estimates_sha256, c.estimates_sha256);
}

TEST_F(ClosedLoop, LogHoldsEveryChannelAndRawEventsOnlyOnRequest) {
  run(smoke(0.7), options("without"));
  RunOptions with_events = options("with");
  with_events.record_events = true;
  run(smoke(0.7), with_events);

  std::map<std::string, int> log = logged("without");
  for (const char* channel :
       {msg::kTruth.name, msg::kVehicleState.name, msg::kPicture.name, msg::kTagDetections.name,
        msg::kTargetEstimate.name, msg::kAttitudeSetpoint.name})
    EXPECT_EQ(log[channel], 70) << channel;  // one a packet
  EXPECT_EQ(log[msg::kImu.name], 700);       // one a millisecond
  EXPECT_EQ(log[msg::kApsFrame.name], 1);    // 0.5 s of exposure
  EXPECT_GE(log[msg::kMissionTransition.name], 1);
  EXPECT_EQ(log.count(msg::kEvents.name), 0u);
  EXPECT_EQ(logged("with")[msg::kEvents.name], 70);
}

TEST_F(ClosedLoop, WrittenScenarioRepeatsTheRun) {
  const Scenario scenario = smoke(0.6);
  const Summary first = run(scenario, options("first"));
  const Summary again = run(load(scratch_.path() / "first" / kScenarioFile), options("again"));
  EXPECT_EQ(first.estimates_sha256, again.estimates_sha256);
}

TEST_F(ClosedLoop, VideoHasAFrameForEveryFortyMilliseconds) {
  RunOptions with_video = options("video");
  with_video.video = true;
  run(smoke(0.4), with_video);
  cv::VideoCapture video((scratch_.path() / "video" / kVideoFile).string());
  ASSERT_TRUE(video.isOpened());
  int frames = 0;
  for (cv::Mat frame; video.read(frame); ++frames) ASSERT_FALSE(frame.empty());
  EXPECT_EQ(frames, 10);
}

TEST_F(ClosedLoop, ARunThatIsStoppedLeavesNothingThatLooksComplete) {
  RunOptions stopped = options("stopped");
  stopped.on_progress = [](double sim_time_s, double, const std::string&) {
    if (sim_time_s > 0.2) throw std::runtime_error("stop");
  };
  EXPECT_THROW(run(smoke(5), stopped), std::runtime_error);
  for (const auto& name : {kSummaryFile, kEstimatesFile, kLogFile, kVideoFile})
    EXPECT_FALSE(std::filesystem::exists(scratch_.path() / "stopped" / name)) << name;
}

TEST_F(ClosedLoop, SummaryHoldsWhatSensorAndRendererCounted) {
  const Summary summary = run(smoke(0.5), options("counts"));
  EXPECT_GE(summary.renders, 0.5 * 200);  // 5 ms apart at most
  // A physics step apart at least, but for the first and the one at the end.
  EXPECT_LE(summary.renders, 0.5 * 2000 + 2);
  EXPECT_LT(summary.renders_late, summary.renders);
  EXPECT_EQ(summary.bad_radiance, 0);
  std::map<std::string, std::uint64_t> calls;
  for (const core::StageTime& time : summary.profile) calls[time.stage] = time.calls;
  EXPECT_EQ(calls.at("draw"), static_cast<std::uint64_t>(summary.renders));
  EXPECT_EQ(calls.at("track"), static_cast<std::uint64_t>(summary.pictures));
}

TEST_F(ClosedLoop, MissedCriteriaAreNamed) {
  Scenario scenario = smoke(0.5);
  const Summary summary = run(scenario, options("short"));
  EXPECT_FALSE(summary.passed);
  EXPECT_THAT(summary.failed_criteria, Contains(testing::HasSubstr("landed")));
}

}  // namespace
}  // namespace nightjar::scenarios
