#include "scenarios/reconstruct_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scenarios/scenario.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "none";
}

TEST(ReconstructSettingsTest, reads_the_sections_of_a_scenario_that_matter) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "a.yaml")
      << "reconstructor:\n  method: htac\n  firenet: {weights: f.onnx}\n"
         "tracker: {detector: {max_hamming: 1}}\n";
  ReconstructSettings settings;
  settings.reconstructor.esi.decay_rate_hz = 77;
  read_settings(folder / "a.yaml", settings);
  EXPECT_EQ(settings.reconstructor.method, esi::Method::htac);
  EXPECT_EQ(settings.tracker.detector.max_hamming, 1);
  EXPECT_EQ(settings.reconstructor.esi.decay_rate_hz, esi::EsiConfig{}.decay_rate_hz);
  EXPECT_EQ(std::filesystem::weakly_canonical(settings.reconstructor.firenet.weights),
            std::filesystem::weakly_canonical(folder / "f.onnx"));
}

TEST(ReconstructSettingsTest, refuses_other_sections_and_values) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "a.yaml") << "reconstructor: {}\nsensor: {}\n";
  ReconstructSettings settings;
  EXPECT_THAT(complaint([&] { read_settings(folder / "a.yaml", settings); }),
              HasSubstr("a.yaml:2:1: sensor: unknown key"));
  EXPECT_THAT(complaint([&] { read_settings(folder / "none.yaml", settings); }),
              HasSubstr("none.yaml"));
}

TEST(ReconstructSettingsTest, a_name_longer_than_files_have_waits_for_who_opens_it) {
  const test::ScratchFolder folder;
  const std::string name = std::string(300, 'w') + ".onnx";
  std::ofstream(folder / "a.yaml") << "reconstructor: {firenet: {weights: " << name << "}}\n";
  ReconstructSettings settings;
  read_settings(folder / "a.yaml", settings);
  EXPECT_TRUE(settings.reconstructor.firenet.weights.ends_with(name));
}

TEST(ReconstructSettingsTest, applies_one_setting_and_keeps_the_others) {
  ReconstructSettings settings;
  settings.reconstructor.esi.decay_power = 3;
  apply_setting("reconstructor.esi.decay_rate_hz=2.5", settings);
  apply_setting("reconstructor.firenet.weights=a=b.onnx", settings);
  EXPECT_EQ(settings.reconstructor.esi.decay_rate_hz, 2.5);
  EXPECT_EQ(settings.reconstructor.esi.decay_power, 3);
  EXPECT_EQ(settings.reconstructor.firenet.weights, "a=b.onnx");
}

TEST(ReconstructSettingsTest, refuses_a_setting_that_is_none) {
  const auto said = [](const std::string& assignment) {
    ReconstructSettings settings;
    return complaint([&] { apply_setting(assignment, settings); });
  };
  EXPECT_EQ(said("fast"), "--set fast: expected NAME=VALUE");
  EXPECT_EQ(said("=1"), "--set =1: expected NAME=VALUE");
  EXPECT_THAT(said("reconstructor.esi.decay_rate_hz=-1"),
              HasSubstr("decay_rate_hz = -1, allowed 0"));
  EXPECT_THAT(said("reconstructor.esi.speed=1"), HasSubstr("speed: unknown key"));
  EXPECT_THAT(said("reconstructor=1"), HasSubstr("reconstructor = 1, expected a section"));
  EXPECT_THAT(said("..=[1"), HasSubstr("--set ..=[1"));
}

TEST(ReconstructSettingsTest, keeps_a_scenarios_weights_where_its_file_means_them) {
  const test::ScratchFolder folder;
  std::filesystem::create_directories(folder / "a");
  std::filesystem::create_directories(folder / "b");
  std::ofstream(folder / "a/arena.xml") << "<mujoco/>";
  std::ofstream(folder / "a/s.yaml")
      << "model: arena.xml\nreconstructor: {e2vid: {weights: w.onnx}}\n";
  const Scenario scenario = load(folder / "a/s.yaml");
  save(scenario, folder / "b/s.yaml");
  EXPECT_THAT(test::file_text(folder / "b/s.yaml"), HasSubstr("weights: \"../a/w.onnx\""));
  EXPECT_EQ(load(folder / "b/s.yaml").reconstructor.e2vid.weights,
            scenario.reconstructor.e2vid.weights);
}

}  // namespace
}  // namespace nightjar::scenarios
