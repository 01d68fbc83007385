#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

// Runs the built program in a folder of its own, without a person to ask.
class BadScenarioTest : public test::ProgramTest {
 protected:
  BadScenarioTest() { std::ofstream(folder_ / "arena.xml") << "<mujoco/>"; }

  void write(const std::string& text) const { std::ofstream(folder_ / "dark.yaml") << text; }

  int run(const std::string& arguments) { return run_program(arguments); }

  // Bad input: exit 2, one line that holds `part`, and no result.
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << err;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "results/summary.json"));
  }

  void expect_refused_text(const std::string& text, const std::string& part) {
    write(text);
    expect_refused("run dark.yaml --out results", part);
  }
};

TEST_F(BadScenarioTest, AnUnknownKeyIsRefused) {
  expect_refused_text("model: arena.xml\nilluminance: 5\n",
                      "dark.yaml:2:1: illuminance: unknown key, nearest is illuminance_lux");
}

TEST_F(BadScenarioTest, TextForANumberIsRefused) {
  expect_refused_text("model: arena.xml\nduration_s: long\n",
                      "dark.yaml:2:1: duration_s = long, expected a number");
}

TEST_F(BadScenarioTest, NegativeLightIsRefused) {
  expect_refused_text("model: arena.xml\nilluminance_lux: -5\n",
                      "dark.yaml:2:1: illuminance_lux = -5, allowed 0.1 to 100000");
}

TEST_F(BadScenarioTest, AMissingModelIsRefused) {
  expect_refused_text("model: none.xml\n", "dark.yaml:1:1: model = none.xml, no such file");
}

TEST_F(BadScenarioTest, NamesLongerThanFilesHaveAreRefused) {
  const std::string name(300, 'n');
  expect_refused_text("model: " + name + ".xml\n", ".xml, no such file");
  write("source: {type: caer, intrinsics: " + name + ".yaml}\n");
  expect_refused("track dark.yaml", ".yaml: no such file");
  write("model: " + name + ".xml\nsource: {type: caer, intrinsics: none.yaml}\n");
  expect_refused("track dark.yaml", "none.yaml: no such file");  // nobody opens the model
  std::ofstream(folder_ / "events.txt") << "0 1 1 1\n0.5 2 2 0\n";
  write("reconstructor: {method: firenet, firenet: {weights: " + name + ".onnx}}\n");
  expect_refused("reconstruct events.txt --config dark.yaml", ".onnx");
}

TEST_F(BadScenarioTest, AModelThatIsNoSceneIsRefused) {
  expect_refused_text("model: arena.xml\n", "arena.xml");
}

TEST_F(BadScenarioTest, ARunThatCannotBeginLeavesNoEarlierOnesResults) {
  fs::create_directories(folder_ / "results");
  std::ofstream(folder_ / "results/summary.json") << "{}";
  std::ofstream(folder_ / "results/run.lcm") << "old";
  expect_refused_text("model: arena.xml\n", "arena.xml");  // no summary.json, among others
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(BadScenarioTest, AFileThatIsNoScenarioLeavesAnEarlierRunsResultsAlone) {
  fs::create_directories(folder_ / "results");
  std::ofstream(folder_ / "results/summary.json") << "{}";
  write("model: [arena.xml\n");
  EXPECT_EQ(run("run dark.yaml --out results"), 2);
  EXPECT_EQ(test::file_text(folder_ / "results/summary.json"), "{}");
}

TEST_F(BadScenarioTest, AnEmptyFileIsRefused) { expect_refused_text("", "dark.yaml:1:1: "); }

TEST_F(BadScenarioTest, BrokenYamlIsRefused) {
  expect_refused_text("model: [arena.xml\n", "not valid YAML");
}

TEST_F(BadScenarioTest, AMissingFileIsRefused) {
  expect_refused("run none.yaml --out results", "none.yaml: no such file");
}

TEST_F(BadScenarioTest, AFolderInsteadOfAFileIsRefused) {
  expect_refused("run . --out results", "a directory, expected a scenario file");
}

TEST_F(BadScenarioTest, AnUnwritableOutputIsRefused) {
  const std::string scenario =
      "run '" NIGHTJAR_SOURCE_DIR "/scenarios/tracking_landing.yaml' --no-video --out ";
  expect_refused(scenario + "arena.xml/results", "arena.xml");  // below a file
  expect_refused(scenario + "arena.xml", "arena.xml");
  expect_refused(scenario + "/proc/nightjar", "/proc/nightjar");  // not even for root
}

TEST_F(BadScenarioTest, ASeedThatIsNoNumberIsRefused) {
  write("model: arena.xml\n");
  for (const std::string seed : {"abc", "1.5", "-1", "99999999999", "''"})
    expect_refused("run dark.yaml --out results --seed " + seed, "--seed");
}

TEST_F(BadScenarioTest, AWrongCommandLineIsRefused) {
  expect_refused("", "subcommand");
  expect_refused("fly", "fly");
  expect_refused("run", "SCENARIO");
  expect_refused("run dark.yaml", "--out");
  expect_refused("run dark.yaml --out results --fast", "--fast");
  expect_refused("parameters --illuminance 5", "--presets");
  expect_refused("parameters --presets --json", "--json");
  expect_refused("parameters --presets --illuminance 0", "--illuminance");
}

TEST_F(BadScenarioTest, HelpIsNoError) {
  EXPECT_EQ(run("run --help"), 0);
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("Examples:"), std::string::npos);
  EXPECT_EQ(run("parameters"), 0);
  EXPECT_NE(out.find("illuminance_lux"), std::string::npos);
  EXPECT_EQ(run("parameters --json"), 0);
  EXPECT_EQ(out.front(), '[');
  EXPECT_EQ(run("parameters --presets --illuminance 50"), 0);
  EXPECT_NE(out.find("at 50 lux"), std::string::npos);
}

}  // namespace
}  // namespace nightjar::tools
