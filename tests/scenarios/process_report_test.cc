#include "scenarios/process_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace nightjar::scenarios {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(ProcessReportTest, AnIntervalHasWhatCameSinceTheOneBefore) {
  ProcessMeter meter("source");
  CameraReport& camera = meter.total().camera.emplace();
  camera.name = "DAVIS346 1";
  camera.counts.events = 100;
  camera.counts.packets_lost = 3;
  meter.count_step();
  meter.total().steps_lost = 2;
  EXPECT_THAT(to_line(meter.take_interval()), HasSubstr("3 packets lost"));
  camera.counts.events = 150;
  camera.counts.disconnects = 1;
  camera.connected = false;
  const ProcessReport second = meter.take_interval();
  EXPECT_EQ(second.steps, 0u);
  EXPECT_EQ(second.steps_lost, 0u);
  ASSERT_TRUE(second.camera);
  EXPECT_EQ(second.camera->counts.events, 50u);
  EXPECT_EQ(second.camera->counts.packets_lost, 0u);
  EXPECT_THAT(to_line(second), HasSubstr("; DAVIS346 1 (disconnected): "));
  EXPECT_THAT(to_line(second), EndsWith(", 1 disconnects"));
  EXPECT_EQ(meter.report().camera->counts.events, 150u);
}

TEST(ProcessReportTest, OnlyASourceWithACameraTellsOfOne) {
  ProcessReport report;
  report.process = "tracker";
  EXPECT_THAT(to_line(report), EndsWith(", nothing lost"));
  EXPECT_FALSE(nlohmann::json::parse(to_json(report)).contains("camera"));
  report.camera.emplace().counts.faults.time_resets = 4;
  EXPECT_EQ(nlohmann::json::parse(to_json(report))["camera"]["clock_resets"], 4);
  EXPECT_THAT(to_line(report), EndsWith("4 clock resets"));
}

}  // namespace
}  // namespace nightjar::scenarios
