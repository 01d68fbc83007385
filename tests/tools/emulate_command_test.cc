#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

/// An 8-bit PGM of one gray code, but for a brighter column.
void write_picture(const fs::path& path, int width, int height, int bright_column) {
  std::string pixels(static_cast<std::size_t>(width * height), '\x32');
  for (int y = 0; y < height; ++y)
    pixels[static_cast<std::size_t>(y * width + bright_column)] = '\xC8';
  std::ofstream(path, std::ios::binary) << fmt::format("P5\n{} {}\n255\n", width, height) << pixels;
}

// Runs the built program in a folder of its own that holds ten frames.
class EmulateCommandTest : public test::ProgramTest {
 protected:
  EmulateCommandTest() {
    fs::create_directory(folder_ / "frames");
    for (int i = 0; i < 10; ++i)
      write_picture(folder_ / fmt::format("frames/{}.pgm", i), 32, 24, 8 + i);
  }

  int run(const std::string& arguments) { return run_program("emulate " + arguments); }

  // Bad input: exit 2, one line that holds `part`, and no file.
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << arguments << '\n' << err;
    expect_one_line(part);
    expect_no_events();
  }

  void expect_no_events() const {
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      EXPECT_FALSE(entry.path().filename().string().starts_with("events")) << entry.path();
  }
};

TEST_F(EmulateCommandTest, writes_the_events_of_a_folder_of_pictures) {
  ASSERT_EQ(run("frames --fps 500 --preset clean --out events.txt"), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("10 of 32x24 px at 500 Hz: 0.018 s"), std::string::npos) << out;
  const std::string events = test::file_text(folder_ / "events.txt");
  // ln(200/50) is 6.9 thresholds of 0.2: 9 columns go dark, 9 bright, of 24 pixels each.
  const auto lines = std::count(events.begin(), events.end(), '\n');
  EXPECT_GT(lines, 2 * 9 * 24 * 6);
  EXPECT_LT(lines, 2 * 9 * 24 * 8);
  EXPECT_FALSE(fs::exists(folder_ / "events.part.txt"));
}

TEST_F(EmulateCommandTest, writes_the_same_bytes_for_the_same_seed_alone) {
  ASSERT_EQ(run("frames --fps 50 --out events.txt --seed 4 --quiet"), 0) << err;
  EXPECT_EQ(out + err, "");
  ASSERT_EQ(run("frames --fps 50 --out again.txt --seed 4 --quiet"), 0);
  ASSERT_EQ(run("frames --fps 50 --out other.txt --seed 5 --quiet"), 0);
  const std::string events = test::file_text(folder_ / "events.txt");
  EXPECT_FALSE(events.empty());
  EXPECT_EQ(test::file_text(folder_ / "again.txt"), events);
  EXPECT_NE(test::file_text(folder_ / "other.txt"), events);
}

TEST_F(EmulateCommandTest, prints_json_alone_on_request) {
  ASSERT_EQ(run("frames --fps 500 --size 16x12 --out events.txt --json"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["width_px"], 16);
  EXPECT_EQ(json["height_px"], 12);
}

TEST_F(EmulateCommandTest, takes_the_sensor_of_a_scenario) {
  std::ofstream(folder_ / "arena.xml") << "<mujoco/>";
  // Too dull for the step of ln(200/50) = 1.39 upwards, and without noise.
  std::ofstream(folder_ / "dark.yaml")
      << "model: arena.xml\nsensor:\n  preset: custom\n  pixel:\n"
         "    threshold_on_log: 2\n    cutoff_hz: 0\n    leak_rate_hz: 0\n"
         "    shot_noise_rate_hz: 0\n    hot_pixel_fraction: 0\n";
  ASSERT_EQ(run("frames --fps 500 --scenario dark.yaml --out events.txt --json"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["events_on"], 0);
  EXPECT_GT(json["events_off"], 0);
  fs::remove(folder_ / "events.txt");
  expect_refused("frames --fps 9 --scenario none.yaml --out events.txt", "none.yaml");
}

TEST_F(EmulateCommandTest, reads_exr_and_warns_of_values_that_are_no_intensity) {
  const char* kSwitch = "OPENCV_IO_ENABLE_OPENEXR";
  setenv(kSwitch, "1", 1);
  fs::create_directory(folder_ / "exr");
  for (const char* name : {"exr/1.exr", "exr/2.exr"})
    ASSERT_TRUE(cv::imwrite((folder_ / name).string(), cv::Mat(4, 4, CV_32F, cv::Scalar(-1))));
  unsetenv(kSwitch);  // the program has to see to it itself, where OpenCV asks for it
  ASSERT_EQ(run("exr --fps 100 --out events.txt --json"), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["bad_values"], 32);
  EXPECT_EQ(err,
            "nightjar: warning: 32 pixels of the frames were negative (taken as 0), NaN, infinite "
            "or beyond 1e20 (taken as the pixel's last value)\n");
}

TEST_F(EmulateCommandTest, takes_the_illuminance_where_it_matters_alone) {
  ASSERT_EQ(run("frames --fps 50 --preset by_illuminance --illuminance 100 --out e.txt"), 0) << err;
  expect_refused("frames --fps 50 --preset by_illuminance --out events.txt", "needs --illuminance");
  expect_refused("frames --fps 50 --preset dim --illuminance 100 --out events.txt",
                 "only matters with the preset by_illuminance");
  expect_refused("frames --fps 50 --preset by_illuminance --illuminance -1 --out events.txt",
                 "--illuminance = -1, allowed 0.1 to 100000");
}

TEST_F(EmulateCommandTest, refuses_frames_that_are_not_there_or_not_right) {
  fs::create_directory(folder_ / "empty");
  expect_refused("empty --fps 50 --out events.txt", "empty: 0 pictures");
  expect_refused("none --fps 50 --out events.txt", "none: no such file or folder");
  expect_refused("frames/1.pgm --fps 50 --out events.txt", "one picture");
  std::ofstream(folder_ / "film.mp4") << "no film";
  expect_refused("film.mp4 --out events.txt", "film.mp4: cannot be read as a video");
  write_picture(folder_ / "frames/5.pgm", 32, 25, 3);
  expect_refused("frames --fps 50 --out events.txt", "5.pgm: 32x25 px, expected 32x24");
  std::ofstream(folder_ / "frames/5.pgm") << "no picture";
  expect_refused("frames --fps 50 --out events.txt", "5.pgm: cannot be read");
}

TEST_F(EmulateCommandTest, refuses_options_that_make_no_sense) {
  expect_refused("frames --out events.txt", "fps is needed");
  expect_refused("frames --fps 0 --out events.txt", "fps = 0, allowed 0.001 to 1000000");
  expect_refused("frames --fps -5 --out events.txt", "fps = -5");
  expect_refused("frames --fps nan --out events.txt", "fps = nan");
  expect_refused("frames --fps fast --out events.txt", "--fps");
  expect_refused("frames --fps 50 --preset dusk --out events.txt",
                 "--preset = dusk, allowed by_illuminance, clean, bright, dim");
  expect_refused("frames --fps 50 --preset custom --out events.txt", "--preset = custom");
  for (const std::string size :
       {"346", "346x", "x260", "346x260x1", "axb", "346X260", "0x5", "32768x5"})
    expect_refused("frames --fps 50 --out events.txt --size " + size, "--size = " + size);
  expect_refused("frames --fps 50 --white 0 --out events.txt", "white = 0");
  expect_refused("frames --fps 50", "--out");
  expect_refused("--fps 50 --out events.txt", "INPUT");
}

TEST_F(EmulateCommandTest, refuses_places_where_no_events_can_go) {
  expect_refused(
      "frames --fps 50 --out events.csv",
      "--out = events.csv, allowed a name ending in .aedat4, .aedat (AEDAT 3.1) or .txt");
  expect_refused("frames --fps 50 --out none/events.txt", "none/events.txt: cannot be written");
  fs::create_directory(folder_ / "folder.txt");
  expect_refused("frames --fps 50 --out folder.txt", "folder.txt: is not a plain file");
}

TEST_F(EmulateCommandTest, leaves_a_users_own_file_of_the_parts_name_alone) {
  std::ofstream(folder_ / "events.part.txt") << "mine";
  ASSERT_EQ(run("frames --fps 50 --out events.txt --quiet"), 0) << err;
  EXPECT_EQ(test::file_text(folder_ / "events.part.txt"), "mine");
  EXPECT_FALSE(test::file_text(folder_ / "events.txt").empty());
}

TEST_F(EmulateCommandTest, explains_itself) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("Examples:"), std::string::npos);
}

TEST_F(EmulateCommandTest, leaves_nothing_when_it_is_interrupted) {
  // Several seconds of frames, all of them one file: the signal comes right at the start.
  write_picture(folder_ / "frame.pgm", 1280, 960, 100);
  fs::create_directory(folder_ / "many");
  for (int i = 0; i < 400; ++i)
    fs::create_symlink(folder_ / "frame.pgm", folder_ / fmt::format("many/{}.pgm", i));
  EXPECT_EQ(test::interrupt_when_there_is(folder_ / "events.part.txt",
                                          {"emulate", (folder_ / "many").string(), "--fps", "1000",
                                           "--out", (folder_ / "events.txt").string(), "--quiet"}),
            130);
  expect_no_events();
}

}  // namespace
}  // namespace nightjar::tools
