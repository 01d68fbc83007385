#include "sim/renderer.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "tests/support/scratch_folder.h"
#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

constexpr core::Resolution kSize{64, 48};
constexpr double kWhite_lux = 5.0;

// Seen from 2 m above (1 m is 29 px): a grey floor, and a white square of 0.4 m whose
// middle lies 0.4 m up and 0.6 m left in the picture, turned so that it has slant edges.
constexpr const char* kModel = R"(<mujoco>
  <visual><headlight ambient="0 0 0" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <light directional="true" dir="0 0 -1" castshadow="false" ambient="0.25 0.25 0.25"
           diffuse="0.75 0.75 0.75" specular="0 0 0"/>
    <geom type="box" size="5 5 0.05" pos="0 0 -0.05" rgba="0.2 0.2 0.2 1"/>
    <geom type="box" size="0.2 0.2 0.005" pos="-0.6 0.4 0.005" euler="0 0 20" rgba="1 1 1 1"/>
    <camera name="down" pos="0 0 2" fovy="45"/>
  </worldbody>
</mujoco>)";

class RendererTest : public testing::Test {
 protected:
  static std::filesystem::path write_model(const std::filesystem::path& path) {
    std::ofstream(path) << kModel;
    return path;
  }

  core::Image<float> draw(core::Resolution size, int supersampling, double white_lux = kWhite_lux) {
    core::Image<float> luminance_lux;
    Renderer renderer(scene_, size, supersampling);
    renderer.draw(scene_, scene_.id(mjOBJ_CAMERA, "down"), white_lux, luminance_lux);
    return luminance_lux;
  }

  test::ScratchFolder scratch_;
  Scene scene_{write_model(scratch_ / "two_greys.xml")};
};

TEST_F(RendererTest, IsLinearInTheLight) {
  const core::Image<float> dim = draw(kSize, 1, 1.0), bright = draw(kSize, 1, 250.0);
  for (int i = 0; i < kSize.pixels(); ++i)  // float rounds at 6e-8
    EXPECT_NEAR(bright.pixels()[i], 250 * dim.pixels()[i], 250 * 1e-6);
}

TEST_F(RendererTest, TopRowIsFirstAndLeftColumnToo) {
  const core::Image<float> picture = draw(kSize, 1);
  // The square's middle: 17 px left of and 12 px above the picture's.
  EXPECT_GT(picture(15, 12), 0.8 * kWhite_lux);
  for (const auto& [x, y] : {std::pair{48, 12}, {15, 35}, {48, 35}})
    EXPECT_LT(picture(x, y), 0.4 * kWhite_lux) << x << ' ' << y;
}

TEST_F(RendererTest, SupersamplingIsTheMeanOfTheFinerPicture) {
  const core::Image<float> fine = draw({2 * kSize.width_px, 2 * kSize.height_px}, 1);
  const core::Image<float> twice = draw(kSize, 2);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x) {
      const float mean = 0.25f * (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) +
                                  fine(2 * x, 2 * y + 1) + fine(2 * x + 1, 2 * y + 1));
      EXPECT_NEAR(twice(x, y), mean, 1e-5 * kWhite_lux) << x << ' ' << y;  // float sums
    }
}

TEST_F(RendererTest, SupersamplingChangesEdgesAndNoFlatArea) {
  const core::Image<float> once = draw(kSize, 1), twice = draw(kSize, 2);
  const auto [dark, bright] = std::minmax_element(once.pixels().begin(), once.pixels().end());
  EXPECT_NEAR(twice(48, 35), once(48, 35), 1e-5 * kWhite_lux);
  const auto between = std::count_if(
      twice.pixels().begin(), twice.pixels().end(), [lo = *dark, hi = *bright](float v) {
        return v > lo + 0.1f * (hi - lo) && v < hi - 0.1f * (hi - lo);
      });
  EXPECT_GT(between, 10);  // of some 45 pixels along the square's edges
}

TEST_F(RendererTest, IsLinearUpToTwiceWhiteAndCutOffBeyond) {
  const auto white_square = [&](const char* ambient, const char* emission) {
    std::string model = kModel;
    model.replace(model.find("0.25 0.25 0.25"), 14, ambient);
    model.replace(model.find("<worldbody>"), 11,
                  std::string("<asset><material name=\"lamp\" rgba=\"1 1 1 1\" emission=\"") +
                      emission + "\"/></asset><worldbody>");
    model.replace(model.find("rgba=\"1 1 1 1\"/>\n    <camera"), 16, "material=\"lamp\"/>");
    std::ofstream(scratch_ / "lamp.xml") << model;
    Scene scene(scratch_ / "lamp.xml");
    core::Image<float> luminance_lux;
    Renderer(scene, kSize, 1)
        .draw(scene, scene.id(mjOBJ_CAMERA, "down"), kWhite_lux, luminance_lux);
    return luminance_lux(15, 12) / kWhite_lux;
  };
  constexpr double kTwoCodes = 2 * Renderer::kBrightest / 65535;
  EXPECT_NEAR(white_square("0.25 0.25 0.25", "0"), 1.0, kTwoCodes);
  EXPECT_NEAR(white_square("1.05 1.05 1.05", "0"), 1.8, kTwoCodes);
  EXPECT_NEAR(white_square("0.25 0.25 0.25", "0.5"), 1.5, kTwoCodes);
  EXPECT_NEAR(white_square("1.05 1.05 1.05", "0.5"), Renderer::kBrightest, kTwoCodes);
}

TEST_F(RendererTest, LightsThatWouldBeCutOffAreRefused) {
  std::string model = kModel;
  model.replace(model.find("0.25 0.25 0.25"), 14, "1.3 1.3 1.3");
  std::ofstream(scratch_ / "glaring.xml") << model;
  Scene scene(scratch_ / "glaring.xml");
  try {
    Renderer renderer(scene, kSize, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("add up to 2.05, allowed 0 to 2"), std::string::npos)
        << e.what();
  }
}

TEST_F(RendererTest, ColoursGiveTheLuminanceOfWhatPeopleSee) {
  for (const char* type : {"2d", "cube"}) {
    std::string model = kModel;
    model.replace(model.find("<worldbody>"), 11,
                  std::string("<asset><texture name=\"paint\" type=\"") + type +
                      "\" builtin=\"flat\" rgb1=\"0.8 0.3 0.1\" width=\"16\" height=\"16\"/>"
                      "<material name=\"painted\" texture=\"paint\" rgba=\"0.5 0.9 0.4 1\"/>"
                      "</asset><worldbody>");
    model.replace(model.find("rgba=\"1 1 1 1\"/>\n    <camera"), 16, "material=\"painted\"/>");
    model.replace(model.find("rgba=\"0.2 0.2 0.2 1\""), 20, "rgba=\"0.9 0.1 0.4 1\"");
    std::ofstream(scratch_ / "painted.xml") << model;
    Scene scene(scratch_ / "painted.xml");
    core::Image<float> luminance_lux;
    Renderer renderer(scene, kSize, 1);
    renderer.draw(scene, scene.id(mjOBJ_CAMERA, "down"), kWhite_lux, luminance_lux);
    // Rec. 709 of texture times material; texels have 8 bits.
    const double painted = 0.2126 * 0.8 * 0.5 + 0.7152 * 0.3 * 0.9 + 0.0722 * 0.1 * 0.4;
    EXPECT_NEAR(luminance_lux(15, 12) / kWhite_lux, painted, 1.0 / 255) << type;
    const double floor = 0.2126 * 0.9 + 0.7152 * 0.1 + 0.0722 * 0.4;
    EXPECT_NEAR(luminance_lux(48, 35) / kWhite_lux, floor, 1e-4) << type;
  }
}

TEST_F(RendererTest, ColouredLightIsRefused) {
  std::string model = kModel;
  model.replace(model.find("0.75 0.75 0.75"), 14, "0.75 0.70 0.75");
  std::ofstream(scratch_ / "pink.xml") << model;
  Scene scene(scratch_ / "pink.xml");
  try {
    Renderer renderer(scene, kSize, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("(0.75 0.7 0.75), allowed grey"), std::string::npos)
        << e.what();
  }
}

TEST_F(RendererTest, AViewIsDrawnAsItWasWhenLookedAt) {
  Scene arena(test::arena());
  Renderer renderer(arena, kSize, 1);
  View view(arena);
  const int dvs = arena.id(mjOBJ_CAMERA, "dvs");
  core::Image<float> at_once, later;
  renderer.draw(arena, dvs, kWhite_lux, at_once);
  view.look(arena, dvs);
  arena.place("uav", Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
  arena.settle();
  std::thread([&] { renderer.draw(view, kWhite_lux, later); }).join();  // and by whom
  EXPECT_EQ(at_once, later);
  renderer.draw(arena, dvs, kWhite_lux, later);
  EXPECT_NE(at_once, later);
}

TEST_F(RendererTest, OneGoesWithoutHarmToAnother) {
  const int camera = scene_.id(mjOBJ_CAMERA, "down");
  Scene arena(test::arena());
  Renderer renderer(arena, kSize, 1);
  core::Image<float> before, after;
  const int dvs = arena.id(mjOBJ_CAMERA, "dvs");
  renderer.draw(arena, dvs, kWhite_lux, before);
  {
    core::Image<float> other_picture;
    Renderer other(scene_, kSize, 1);
    other.draw(scene_, camera, kWhite_lux, other_picture);
    renderer.draw(arena, dvs, kWhite_lux, after);  // the current one when the other goes
  }
  renderer.draw(arena, dvs, kWhite_lux, after);
  EXPECT_EQ(before, after);
}

TEST_F(RendererTest, ACameraThatIsNotThereIsRefusedByItsName) {
  try {
    scene_.id(mjOBJ_CAMERA, "up");
    FAIL() << "found";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("no camera named 'up'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace nightjar::sim
