#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

class SensorReportCommandTest : public test::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  int run(const std::string& arguments, const std::string& environment = "") {
    return run_program("sensor-report " + arguments, environment);
  }

  // One line that holds `part`, no result, no file left behind.
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << err;
    expect_only_a_line(part);
  }

  void expect_only_a_line(const std::string& part) const {
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "report.png"));
    EXPECT_FALSE(fs::exists(folder_ / "report.part.png"));
  }

  const std::string kShort = " --duration 0.2 --size 32x24 ";
};

TEST_F(SensorReportCommandTest, prints_a_table_with_a_column_for_the_recording) {
  write("events.txt", "0.5 1 1 1\n0.6 2 2 0\n");
  ASSERT_EQ(run(kShort + "--preset dim --recording events.txt"), 0) << err;
  EXPECT_EQ(err, "");
  for (const std::string part : {"preset dim, 5 lux, seed 1", "at rest", "moving", "events.txt",
                                 "32x24 px", "quiet pixels", "hot pixels", "ON share", "99 %"})
    EXPECT_NE(out.find(part), std::string::npos) << part;
}

TEST_F(SensorReportCommandTest, prints_json_for_scripts) {
  ASSERT_EQ(run(kShort + "--preset clean --illuminance 1000 --seed 4 --json"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["preset"], "clean");
  EXPECT_EQ(json["illuminance_lux"], 1000);
  EXPECT_EQ(json["seed"], 4);
  EXPECT_EQ(json["columns"].size(), 2u);
}

TEST_F(SensorReportCommandTest, a_recording_without_a_size_keeps_its_own) {
  write("events.txt", "0.5 9 1 1\n0.6 2 4 0\n");
  ASSERT_EQ(run("--duration 0.2 --preset clean --json --recording events.txt"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["columns"][0]["width_px"], 346);
  EXPECT_EQ(json["columns"][2]["width_px"], 10);
  EXPECT_EQ(json["columns"][2]["height_px"], 5);
}

TEST_F(SensorReportCommandTest, takes_the_sensor_of_a_scenario) {
  const std::string scenario =
      "--scenario '" NIGHTJAR_SOURCE_DIR "/scenarios/tracking_landing.yaml' --duration 0.2 ";
  ASSERT_EQ(run(scenario + "--json"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["illuminance_lux"], 5);
  EXPECT_EQ(json["columns"][0]["width_px"], 346);
  ASSERT_EQ(run(scenario + "--illuminance 20 --size 40x30 --json"), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["illuminance_lux"], 20);
  EXPECT_EQ(nlohmann::json::parse(out)["columns"][0]["width_px"], 40);
  expect_refused(scenario + "--preset dim", "--preset");
}

TEST_F(SensorReportCommandTest, draws_a_png) {
  ASSERT_EQ(run(kShort + "--out report.png"), 0) << err;
  EXPECT_EQ(test::file_text(folder_ / "report.png").substr(1, 3), "PNG");
  EXPECT_FALSE(fs::exists(folder_ / "report.part.png"));
}

// Files may have 512 * 400 bytes, but for those of a stand-in for gnuplot.
TEST_F(SensorReportCommandTest, a_disk_that_does_not_take_the_picture_is_no_bad_input) {
  write("gnuplot", "#!/bin/sh\nulimit -S -f unlimited\nhead -c 1000000 /dev/zero\n");
  fs::permissions(folder_ / "gnuplot", fs::perms::owner_all);
  EXPECT_EQ(run(kShort + "--out report.png", "trap '' XFSZ; ulimit -S -f 400; PATH=.:$PATH"), 3);
  expect_only_a_line("report.png: cannot be written");
}

TEST_F(SensorReportCommandTest, an_output_that_cannot_be_is_refused_before_the_work) {
  expect_refused(kShort + "--out none/report.png", "none/report.png");
  expect_refused(kShort + "--out report.jpg", "report.jpg");
  EXPECT_FALSE(fs::exists(folder_ / "report.jpg"));
  fs::create_directory(folder_ / "folder.png");
  expect_refused(kShort + "--out folder.png", "folder.png: is not a plain file");
}

TEST_F(SensorReportCommandTest, the_shortest_and_slowest_report_is_a_report) {
  ASSERT_EQ(run("--duration 0.1 --speed 10 --size 32x24 --json"), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["columns"][1]["duration_s"], 0.025);
}

TEST_F(SensorReportCommandTest, its_help_tells_the_ranges_and_the_exit_codes) {
  EXPECT_EQ(run("--help"), 0);
  for (const std::string part : {"0.1 to 60", "10 to 2000", "by_illuminance, clean, bright, dim",
                                 "Exit codes: 0 done, 2 bad input, 3 "})
    EXPECT_NE(out.find(part), std::string::npos) << part;
}

TEST_F(SensorReportCommandTest, a_missing_gnuplot_is_named) {
  EXPECT_EQ(run(kShort + "--out report.png", "PATH=/none"), 3);
  expect_only_a_line("gnuplot");
}

TEST_F(SensorReportCommandTest, bad_recordings_are_refused) {
  write("empty.txt", "# nothing\n");
  write("outside.txt", "0.5 1 1 1\n0.6 32 2 0\n");
  write("backwards.txt", "0.5 1 1 1\n0.4 2 2 0\n");
  write("once.txt", "0.5 1 1 1\n");
  write("words.txt", "now here there\n");
  expect_refused(kShort + "--recording none.txt", "none.txt: ");
  expect_refused(kShort + "--recording .", "cannot be read");
  expect_refused(kShort + "--recording empty.txt", "empty.txt: 0 events");
  expect_refused(kShort + "--recording outside.txt", "outside.txt:2: x = 32, allowed 0 to 31");
  expect_refused(kShort + "--recording backwards.txt", "backwards.txt:2: ");
  expect_refused(kShort + "--recording once.txt", "once.txt: 1 events");
  expect_refused(kShort + "--recording words.txt", "words.txt:1: ");
}

TEST_F(SensorReportCommandTest, a_wrong_command_line_is_refused) {
  for (const std::string size :
       {"346", "x260", "346x", "346x260x1", "0x10", "-3x4", "99999x9", "''x"})
    expect_refused("--size " + size, "--size");
  expect_refused("--size 8x8", "size.width_px = 8, allowed 16 to 2048");
  expect_refused("--size ''", "--size = ,");
  expect_refused("--preset custom", "--preset = custom, allowed by_illuminance, clean");
  expect_refused("--preset bleak", "--preset = bleak, allowed by_illuminance, clean, bright, dim");
  expect_refused("--illuminance 0", "illuminance_lux = 0");
  expect_refused("--illuminance nan", "illuminance");
  expect_refused("--duration -1", "duration_s = -1");
  expect_refused("--duration 1e9", "duration_s");
  expect_refused("--speed 0", "speed_px_s = 0");
  expect_refused("--seed -1", "--seed");
  expect_refused("--scenario none.yaml", "none.yaml");
}

}  // namespace
}  // namespace nightjar::tools
