#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

WorldConfig standing(const std::array<double, 3>& start_from_tag_m) {
  WorldConfig config;
  config.start_from_tag_m = start_from_tag_m;
  config.ugv.course = {{-5, -3, 0.0, CoursePhase::straight}, {5, -3, 0.0, CoursePhase::straight}};
  return config;
}

core::AttitudeSetpoint hover() {
  core::AttitudeSetpoint setpoint;
  setpoint.thrust_m_s2 = 9.81;
  return setpoint;
}

TEST(World, TagAndCameraLieAsTheFramesDocumentSays) {
  World world(standing({0, 0, 1.5}), CameraConfig{}, test::arena(), 1);
  const core::Truth truth = world.truth();
  // UGV along world x on level ground: tag axes are the world's, but for what the
  // wheels sink into the floor.
  EXPECT_TRUE(truth.T_world_tag.linear().isIdentity(1e-3));
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  EXPECT_TRUE(world.T_body_camera().linear().isApprox(R_body_camera, 1e-12));
  EXPECT_NEAR((truth.uav.p_world_body_m - truth.T_world_tag.translation() -
               Eigen::Vector3d(0, 0, 1.5)).norm(), 0.0, 1e-9);
}

TEST(World, TheTagIsDrawnWhereTruthProjectsIt) {
  World world(standing({0.1, -0.2, 1.2}), CameraConfig{}, test::arena(), 1);
  core::Image<float> luminance_lux;
  world.draw(5.0, luminance_lux);
  const core::Truth truth = world.truth();
  const auto pixel_of = [&](double x_m, double y_m) {
    const Eigen::Vector3d p = truth.T_world_camera.inverse() * truth.T_world_tag *
                              Eigen::Vector3d(x_m, y_m, 0);
    const Eigen::Vector2d pixel = *world.camera_model().project(p);
    return luminance_lux(static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
  };
  // Middle of the white border and of the black ring inside it, on each side; cells are
  // 3 cm. Paper reflects 0.85, ink 0.05.
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    EXPECT_NEAR(pixel_of(0.135 * x, 0.135 * y), 5 * 0.85, 0.15) << x << ' ' << y;
    EXPECT_NEAR(pixel_of(0.105 * x, 0.105 * y), 5 * 0.05, 0.05) << x << ' ' << y;
  }
}

TEST(World, RadianceIsNotMadeOfEightBitSteps) {
  World world(standing({0, 0, 1.5}), CameraConfig{}, test::arena(), 1);
  core::Image<float> luminance;
  world.draw(1.0, luminance);
  const auto in_steps = std::count_if(
      luminance.pixels().begin(), luminance.pixels().end(), [](float v) {
        return std::abs(255 * v - std::round(255 * v)) < 1e-3f;
      });
  // By chance 0.2 % of values lie so near to a step; an 8-bit chain would have them all.
  EXPECT_LT(in_steps, luminance.size().pixels() / 20);
}

TEST(World, StandingOnTheBoardIsNoCrash) {
  World world(standing({0, 0, 0.12}), CameraConfig{}, test::arena(), 1);
  core::AttitudeSetpoint off;
  off.motors_on = false;
  world.command(off);
  for (int i = 0; i < 600; ++i) world.step();
  EXPECT_TRUE(world.truth().on_board);
  EXPECT_FALSE(world.truth().crashed);
}

TEST(World, FallingBesideTheUgvIsACrash) {
  World world(standing({1.5, 0, 0.3}), CameraConfig{}, test::arena(), 1);
  core::AttitudeSetpoint off;
  off.motors_on = false;
  world.command(off);
  for (int i = 0; i < 1000; ++i) world.step();
  EXPECT_TRUE(world.truth().crashed);
}

TEST(World, DrivingIntoACrateIsSeen) {
  WorldConfig config;
  config.start_from_tag_m = {0, 0, 2};
  config.ugv.course = {{4.0, -1.6, 0.5, CoursePhase::straight},
                       {7.0, -1.6, 0.5, CoursePhase::straight}};
  World world(config, CameraConfig{}, test::arena(), 1);
  world.command(hover());
  for (int i = 0; i < 4000 && !world.truth().ugv_collided; ++i) world.step();
  EXPECT_TRUE(world.truth().ugv_collided);
}

TEST(World, ChaseViewShowsColours) {
  World world(standing({0, 0, 1.5}), CameraConfig{}, test::arena(), 1);
  core::Image<Rgb> view({320, 240});
  world.draw_chase(view);
  const std::set<Rgb> colours(view.pixels().begin(), view.pixels().end());
  EXPECT_GT(colours.size(), 100u);  // the floor's texture alone has more greys than that
  EXPECT_TRUE(std::any_of(colours.begin(), colours.end(),
                          [](const Rgb& c) { return c[0] > c[2] + 60; }));  // orange propellers
}

}  // namespace
}  // namespace nightjar::sim
