#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/gray_picture.h"
#include "scenarios/intrinsics.h"
#include "tests/support/board_pictures.h"
#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CalibrateCommandTest : public test::ProgramTest {
 protected:
  int run(const std::string& arguments) { return run_program("calibrate " + arguments); }

  /// A folder of views of a 9 x 6 checkerboard.
  void write_checkerboards(int count) const {
    const test::BoardCamera camera(test::distorting_camera());
    fs::create_directory(folder_ / "boards");
    for (int i = 0; i < count; ++i)
      scenarios::write_png(
          folder_ / ("boards/" + std::to_string(i) + ".png"),
          camera
              .draw(test::checkerboard_paint({}),
                    test::board_pose(i, {0.12, 0.075}, 0.3, test::kCheckerboardFace))
              .gray);
  }

  void write_tags(int count) const {
    const test::BoardCamera camera(test::distorting_camera());
    const auto board = test::tag_board();
    fs::create_directory(folder_ / "tags");
    for (int i = 0; i < count; ++i)
      scenarios::write_png(
          folder_ / ("tags/" + std::to_string(i) + ".png"),
          camera
              .draw(test::tag_board_paint(board),
                    test::board_pose(i, test::kTagBoardMiddle_m, 0.28, test::kTagFace))
              .gray);
    std::ofstream layout(folder_ / "layout.yaml");
    layout << "tags:\n";
    for (const auto& tag : board.tags)
      layout << "  - {id: " << tag.id << ", size_m: " << tag.size_m << ", x_m: " << tag.x_m
             << ", y_m: " << tag.y_m << "}\n";
  }

  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << arguments << '\n' << err;
    expect_one_line(part);
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      EXPECT_FALSE(entry.path().filename().string().starts_with("camera")) << entry.path();
  }
};

TEST_F(CalibrateCommandTest, recovers_a_known_camera_from_pictures_of_a_checkerboard) {
  write_checkerboards(16);
  ASSERT_EQ(run("boards --board checkerboard --out camera.yaml --json"), 0) << err;
  const json result = json::parse(out);
  EXPECT_EQ(result["pictures"], 16);
  EXPECT_EQ(result["views"].size(), 16u);
  EXPECT_LT(result["rms_px"], 0.2);
  const core::CameraModel truth = test::distorting_camera();
  const std::map<std::string, double> expected = {{"fx_px", truth.fx_px}, {"fy_px", truth.fy_px},
                                                  {"cx_px", truth.cx_px}, {"cy_px", truth.cy_px},
                                                  {"k1", truth.lens.k1},  {"k2", truth.lens.k2},
                                                  {"p1", truth.lens.p1},  {"p2", truth.lens.p2}};
  for (const auto& [name, value] : expected)  // by four standard deviations, as it gives them
    EXPECT_NEAR(result["intrinsics"][name], value, 4 * result["sigma"][name].get<double>()) << name;
  EXPECT_LT(result["sigma"]["fx_px"], 1.0);
  const core::CameraModel read = scenarios::read_intrinsics(folder_ / "camera.yaml");
  EXPECT_EQ(read.fx_px, result["intrinsics"]["fx_px"]);
  EXPECT_EQ(read.lens.k1, result["intrinsics"]["k1"]);
  EXPECT_EQ(test::file_text(folder_ / "camera.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(CalibrateCommandTest, recovers_it_from_a_tag_board_to_a_hundredth) {
  write_tags(12);
  ASSERT_EQ(run("tags --board tags --layout layout.yaml --out camera.yaml --json"), 0) << err;
  const core::CameraModel truth = test::distorting_camera();
  const json result = json::parse(out);
  EXPECT_LT(result["rms_px"], 0.2);
  // AprilTag's corners of tags this small are a tenth of a pixel off, and not at random: with 24
  // views the focal length is half a percent short, four standard deviations.
  EXPECT_NEAR(result["intrinsics"]["fx_px"], truth.fx_px, 0.01 * truth.fx_px);
  EXPECT_NEAR(result["intrinsics"]["fy_px"], truth.fy_px, 0.01 * truth.fy_px);
  EXPECT_NEAR(result["intrinsics"]["k1"], truth.lens.k1, 0.02);
  EXPECT_NEAR(result["intrinsics"]["cx_px"], truth.cx_px, 3.0);
}

TEST_F(CalibrateCommandTest, says_what_views_lack) {
  write_checkerboards(9);
  ASSERT_EQ(run("boards --board checkerboard --out camera.yaml --quiet"), 0) << err;
  EXPECT_NE(err.find("warning: corners lie in "), std::string::npos) << err;
  EXPECT_EQ(out, "");
}

TEST_F(CalibrateCommandTest, too_few_boards_end_in_one_line_and_no_file) {
  write_checkerboards(5);
  expect_refused("boards --board checkerboard --out camera.yaml",
                 "boards: the board is in 5 of 5 pictures, 5 of these views differ, expected at "
                 "least 8");
  expect_refused("boards --board checkerboard --corners 8x6 --out camera.yaml",
                 "in 0 of 5 pictures");
  expect_refused("boards --board tags --out camera.yaml", "in 0 of 5 pictures");
}

TEST_F(CalibrateCommandTest, bad_input_ends_in_one_line_and_no_file) {
  std::ofstream(folder_ / "events.txt") << "0 1 1 1\n0.5 2 2 0\n";
  std::ofstream(folder_ / "layout.yaml") << "tags: [{id: 1, side: 2}]\n";
  std::ofstream(folder_ / "twice.yaml") << "tags: [{id: 1}, {id: 1}]\n";
  std::ofstream(folder_ / "empty.txt") << "# nothing\n";
  expect_refused("none.aedat4 --board checkerboard --out camera.yaml", "none.aedat4");
  expect_refused("events.txt --board checkerboard --out camera.png", "ending in .yaml");
  expect_refused("events.txt --board circles --out camera.yaml", "circles");
  expect_refused("events.txt --board checkerboard --corners 9by6 --out camera.yaml",
                 "--corners = 9by6, expected columns and rows, 9x6");
  expect_refused("events.txt --board checkerboard --corners 2x6 --out camera.yaml",
                 "corners.columns = 2, allowed 3 to 50");
  expect_refused("events.txt --board checkerboard --layout layout.yaml --out camera.yaml",
                 "--layout is for --board tags");
  expect_refused("events.txt --board tags --layout layout.yaml --out camera.yaml",
                 "layout.yaml:1:16: tags[0].side: unknown key");
  expect_refused("events.txt --board checkerboard --method magic --out camera.yaml",
                 "--method = magic");
  expect_refused("events.txt --board checkerboard --frames --out camera.yaml",
                 "events.txt: the recording has no frames");
  expect_refused("empty.txt --size 20x20 --board checkerboard --out camera.yaml",
                 "empty.txt: no events");
  expect_refused("events.txt --board tags --layout twice.yaml --out camera.yaml",
                 "twice.yaml: board.tags: id = 1 is there twice");
  expect_refused("events.txt --board checkerboard --out camera.yaml", "in 0 of 5 pictures");
}

TEST_F(CalibrateCommandTest, options_that_would_do_nothing_are_refused) {
  std::ofstream(folder_ / "events.txt") << "0 1 1 1\n0.5 2 2 0\n";
  fs::create_directory(folder_ / "boards");
  const std::string rest = " --out camera.yaml";
  for (const char* option : {"--corners 9x6", "--square-m 0.03"})
    expect_refused(std::string("events.txt --board tags ") + option + rest,
                   " is for --board checkerboard");
  for (const char* option : {"--method esi", "--fps 10", "--frames", "--size 20x20"})
    expect_refused(std::string("boards --board tags ") + option + rest,
                   " is for recordings, not for a folder of pictures");
  for (const char* option : {"--method esi", "--fps 10"})
    expect_refused(std::string("events.txt --frames --board tags ") + option + rest,
                   " is for events, not for --frames");
  for (const char* fps : {"0", "1e6", "nan"})
    expect_refused(std::string("none.txt --board tags --fps ") + fps + rest,
                   "allowed 0.01 to 100000");
}

TEST_F(CalibrateCommandTest, says_what_of_the_recording_could_not_be_used) {
  std::ofstream(folder_ / "events.txt") << "0 1 1 1\n0.5 2 2 0\n0.3 2 2 0\n";
  EXPECT_EQ(run("events.txt --size 20x20 --board checkerboard --out camera.yaml"), 2);
  EXPECT_NE(err.find("warning: "), std::string::npos) << err;
  EXPECT_NE(err.find("1 running backwards"), std::string::npos) << err;
}

TEST_F(CalibrateCommandTest, leaves_nothing_when_it_is_interrupted) {
  {  // So long that the signal comes while the sensor's size is looked for.
    std::ofstream events(folder_ / "events.txt");
    for (int i = 0; i < 1'000'000; ++i) events << i * 1e-6 << " 300 200 1\n";
  }
  EXPECT_EQ(test::interrupt_when_there_is(
                folder_ / "camera.part.yaml",
                {"calibrate", (folder_ / "events.txt").string(), "--board", "checkerboard", "--out",
                 (folder_ / "camera.yaml").string(), "--quiet"}),
            130);
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    EXPECT_EQ(entry.path().filename(), "events.txt");
}

}  // namespace
}  // namespace nightjar::tools
