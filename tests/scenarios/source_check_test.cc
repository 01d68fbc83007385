#include "scenarios/source_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/loop.h"

namespace nightjar::scenarios {
namespace {

using camera::SourceType;
using testing::HasSubstr;

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "no error";
}

Scenario smoke_with(const std::string& source) {
  const std::string folder = NIGHTJAR_SOURCE_DIR "/scenarios/";
  return parse("name: swapped\nmodel: ../models/arena.xml\n" + source, folder + "swapped.yaml");
}

TEST(SourceCheckTest, one_line_of_a_scenario_swaps_the_simulator_for_a_camera) {
  const Scenario simulated = smoke_with("");
  const Scenario real = smoke_with("source: {type: caer}\n");
  EXPECT_EQ(error_of([&] { check_source(simulated, SourceType::simulation); }), "no error");
  EXPECT_EQ(error_of([&] { check_source(real, SourceType::caer); }), "no error");
  EXPECT_THAT(error_of([&] { check_source(simulated, SourceType::caer); }),
              HasSubstr("source.type = simulation, expected caer"));
  EXPECT_THAT(error_of([&] { check_source(real, SourceType::simulation); }),
              HasSubstr("source.type = caer, expected simulation"));
}

TEST(SourceCheckTest, a_scenario_sets_the_camera_up) {
  const Scenario scenario = smoke_with(
      "source:\n  type: caer\n  caer:\n    serial: \"00000123\"\n    packet_interval_ms: 1\n"
      "    biases: {pr: {fine: 116}, pr_sf: {fine: 33}}\n"
      "    hardware_filter: {background_activity: false}\n");
  EXPECT_EQ(scenario.source.caer.serial, "00000123");
  EXPECT_EQ(scenario.source.caer.packet_interval_ms, 1.0);
  EXPECT_EQ(scenario.source.caer.biases.pr.coarse, 2);
  EXPECT_EQ(scenario.source.caer.biases.pr.fine, 116);
  EXPECT_FALSE(scenario.source.caer.hardware_filter.background_activity);
}

TEST(SourceCheckTest, errors_name_the_line_of_a_bias_out_of_range) {
  EXPECT_THAT(error_of([] { smoke_with("source:\n  caer:\n    biases: {off: {coarse: 8}}\n"); }),
              HasSubstr("swapped.yaml:5:20: source.caer.biases.off.coarse = 8, allowed 0 to 7"));
}

TEST(SourceCheckTest, a_real_camera_has_its_own_size) {
  EXPECT_THAT(error_of([] { smoke_with("source: {type: caer}\ncamera: {width_px: 240}\n"); }),
              HasSubstr("camera.width_px = 240, camera.height_px = 260, allowed 346 and 260 with "
                        "source.type = caer"));
}

TEST(SourceCheckTest, no_simulator_flies_in_place_of_a_camera) {
  EXPECT_THAT(error_of([] { run(smoke_with("source: {type: caer}\n"), {}); }),
              HasSubstr("source.type = caer"));
}

}  // namespace
}  // namespace nightjar::scenarios
