#include "scenarios/intrinsics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "scenarios/loop.h"
#include "scenarios/scenario.h"
#include "scenarios/yaml_writer.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

constexpr const char* kFile =
    "width_px: 346\nheight_px: 260\nfx_px: 301.2\nfy_px: 299.4\ncx_px: 169.3\ncy_px: 133.1\n"
    "k1: -0.21\nk2: 0.07\np1: 0.0012\np2: -0.0008\nk3: 0\n";

class IntrinsicsTest : public testing::Test {
 protected:
  IntrinsicsTest() { write("camera.yaml", kFile); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  std::string complaint(const std::string& text) const {
    write("bad.yaml", text);
    try {
      read_intrinsics(folder_ / "bad.yaml");
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "no error";
  }

  /// A scenario file in the folder with this line.
  Scenario scenario_with(const std::string& line) const {
    write("s.yaml", "model: " NIGHTJAR_SOURCE_DIR "/models/arena.xml\n" + line);
    return load(folder_ / "s.yaml");
  }

  std::string refusal(const std::string& line) const {
    try {
      scenario_with(line);
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "no error";
  }

  test::ScratchFolder folder_;
};

TEST_F(IntrinsicsTest, reads_every_number) {
  const core::CameraModel camera = read_intrinsics(folder_ / "camera.yaml");
  EXPECT_EQ(camera.size, (core::Resolution{346, 260}));
  EXPECT_EQ(camera.fx_px, 301.2);
  EXPECT_EQ(camera.fy_px, 299.4);
  EXPECT_EQ(camera.cx_px, 169.3);
  EXPECT_EQ(camera.cy_px, 133.1);
  EXPECT_EQ(camera.lens, (core::Lens{-0.21, 0.07, 0.0012, -0.0008, 0}));
}

TEST_F(IntrinsicsTest, errors_name_file_line_and_range) {
  const std::string file = kFile;
  EXPECT_THAT(complaint(file + "k4: 0.1\n"), HasSubstr("bad.yaml:12:1: k4: unknown key"));
  EXPECT_THAT(complaint("width_px: 346\nheight_px: 260\nfx_px: -3\n"),
              HasSubstr("bad.yaml:3:1: fx_px = -3, allowed 1 to 1000000"));
  EXPECT_THAT(complaint("width_px: 346\nheight_px: 260\nfx_px: 300\n"),
              HasSubstr("bad.yaml: fy_px = 0, allowed 1 to 1000000"));
  EXPECT_THAT(complaint("k1: .nan\n"), HasSubstr("k1"));
}

TEST_F(IntrinsicsTest, refuses_a_lens_that_turns_back_within_the_picture) {
  const std::string pinhole =
      "width_px: 346\nheight_px: 260\nfx_px: 300\nfy_px: 300\ncx_px: 172.5\ncy_px: 129.5\n";
  // r - 0.4 r^3 is at most 0.61, the picture's corner is at 0.72, its sides' middle at 0.575.
  EXPECT_THAT(complaint(pinhole + "k1: -0.4\n"), HasSubstr("turns back within the picture"));
  EXPECT_EQ(complaint(pinhole + "k1: -0.25\n"), "no error");  // at most 0.77
}

TEST_F(IntrinsicsTest, a_scenario_reads_the_file_beside_it) {
  const Scenario scenario = scenario_with("source: {type: caer, intrinsics: camera.yaml}\n");
  EXPECT_EQ(camera_model(scenario).lens.k1, -0.21);
  EXPECT_EQ(camera_model(scenario).fx_px, 301.2);
}

TEST_F(IntrinsicsTest, a_saved_scenario_still_finds_the_file) {
  const Scenario scenario = scenario_with("source: {type: caer, intrinsics: camera.yaml}\n");
  std::filesystem::create_directories(folder_ / "deep/er");
  save(scenario, folder_ / "deep/er/scenario.yaml");
  EXPECT_EQ(to_yaml(load(folder_ / "deep/er/scenario.yaml")), to_yaml(scenario));
}

TEST_F(IntrinsicsTest, without_a_file_the_camera_is_the_sections_pinhole) {
  const core::CameraModel camera = camera_model(scenario_with("camera: {fovy_deg: 60}\n"));
  EXPECT_TRUE(camera.lens.is_ideal());
  EXPECT_DOUBLE_EQ(camera.fy_px, 130 / std::tan(30 * std::numbers::pi / 180));
}

TEST_F(IntrinsicsTest, the_simulator_refuses_a_real_lens_and_says_why) {
  EXPECT_THAT(refusal("source: {intrinsics: camera.yaml}\n"),
              HasSubstr("allowed only with source.type = caer: the simulator draws the ideal "
                        "pinhole of camera.fovy_deg, without distortion"));
}

TEST_F(IntrinsicsTest, the_file_must_be_there_and_of_the_cameras_size) {
  EXPECT_THAT(refusal("source: {type: caer, intrinsics: none.yaml}\n"),
              HasSubstr("none.yaml: no such file"));
  EXPECT_THAT(refusal("source: {type: caer, intrinsics: " + std::string(300, 'i') + ".yaml}\n"),
              HasSubstr(".yaml: no such file"));
  std::string small = kFile;
  small.replace(small.find("346"), 3, "240");
  write("camera.yaml", small);
  EXPECT_THAT(refusal("source: {type: caer, intrinsics: camera.yaml}\n"),
              HasSubstr("is of a camera with 240 x 260 px, allowed 346 x 260"));
}

}  // namespace
}  // namespace nightjar::scenarios
