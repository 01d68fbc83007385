#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

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

core::AttitudeSetpoint motors_off() {
  core::AttitudeSetpoint setpoint;
  setpoint.motors_on = false;
  return setpoint;
}

/// Steps for `duration`, or until `done` says so.
void fly(World& world, core::Time duration, const std::function<bool()>& done = {}) {
  const core::Time end = world.now() + duration;
  while (world.now() < end && !(done && done())) world.step();
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
  EXPECT_NEAR(
      (truth.uav.p_world_body_m - truth.T_world_tag.translation() - Eigen::Vector3d(0, 0, 1.5))
          .norm(),
      0.0, 1e-9);
}

/// The mean difference of two pictures, in lux.
double apart(const core::Image<float>& a, const core::Image<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    sum += std::abs(a.pixels()[i] - b.pixels()[i]);
  return sum / static_cast<double>(a.pixels().size());
}

TEST(World, WhatWasSeenBetweenTwoStepsLiesBetweenThem) {
  World world(standing({0, 0, 1.5}), CameraConfig{}, test::arena(), 1);
  world.command(motors_off());
  fly(world, 300ms);  // 3 m/s
  View view(world.scene());
  const auto seen_at = [&](core::Time t) {
    core::Image<float> picture;
    world.look(t, view);
    world.renderer().draw(view, 5.0, picture);
    return picture;
  };
  const core::Image<float> before = seen_at(world.now());
  world.step();
  const core::Image<float> now = seen_at(world.now());
  const core::Image<float> half = seen_at(world.now() - world.time_step() / 2);
  const double step = apart(before, now);
  EXPECT_LT(apart(before, seen_at(world.now() - world.time_step())), 0.01 * step);
  // In the middle, were pictures straight in time; they nearly are, but for outlines.
  EXPECT_NEAR(apart(before, half), 0.5 * step, 0.15 * step);
  EXPECT_NEAR(apart(half, now), 0.5 * step, 0.15 * step);
}

TEST(World, TheTagIsDrawnWhereTruthProjectsIt) {
  World world(standing({0.1, -0.2, 1.2}), CameraConfig{}, test::arena(), 1);
  core::Image<float> luminance_lux;
  world.draw(5.0, luminance_lux);
  const core::Truth truth = world.truth();
  const auto pixel_of = [&](double x_m, double y_m) {
    const Eigen::Vector3d p =
        truth.T_world_camera.inverse() * truth.T_world_tag * Eigen::Vector3d(x_m, y_m, 0);
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
  const std::set<float> values(luminance.pixels().begin(), luminance.pixels().end());
  // One 8-bit step anywhere on the way leaves at most 256 values for each of the few
  // differently lit or tinted surfaces in view; 16 bits leave 32,767 up to white.
  EXPECT_GT(values.size(), 5000u);
}

TEST(World, StandingOnTheBoardIsNoCrash) {
  World world(standing({0, 0, 0.12}), CameraConfig{}, test::arena(), 1);
  world.command(motors_off());
  fly(world, 600ms);
  EXPECT_TRUE(world.truth().on_board);
  EXPECT_FALSE(world.truth().crashed);
}

TEST(World, FallingBesideTheUgvIsACrash) {
  World world(standing({1.5, 0, 0.3}), CameraConfig{}, test::arena(), 1);
  world.command(motors_off());
  fly(world, 1s);
  EXPECT_TRUE(world.truth().crashed);
}

TEST(World, LandingUpsideDownOnTheBoardIsACrash) {
  WorldConfig config = standing({0, 0, 2.5});
  config.autopilot.tilt_sigma_deg = config.autopilot.heading_sigma_deg = 0;
  World world(config, CameraConfig{}, test::arena(), 1);
  core::AttitudeSetpoint flip = hover();
  flip.thrust_m_s2 = 0;
  flip.q_world_body = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitX());
  world.command(flip);
  const auto above_tag_m = [&] {
    const core::Truth truth = world.truth();
    return Eigen::Vector3d(truth.uav.p_world_body_m - truth.T_world_tag.translation());
  };
  fly(world, 2s, [&] { return world.truth().crashed || world.truth().on_board; });
  EXPECT_TRUE(world.truth().crashed);
  EXPECT_FALSE(world.truth().on_board);
  // It is the board that it lies on: 0.3 m from its middle to its edge, and the hull is
  // 0.04 m from its middle to its top.
  EXPECT_LT(world.truth().uav.q_world_body.toRotationMatrix()(2, 2), -0.9);
  EXPECT_LT(above_tag_m().head<2>().cwiseAbs().maxCoeff(), 0.3);
  EXPECT_NEAR(above_tag_m().z(), 0.04, 0.02);
}

TEST(World, TheHullAgainstTheBoardsEdgeIsACrash) {
  // 0.3 m to the edge, 0.15 m of hull; the feet, 0.08 m out, stay beside the board.
  World world(standing({0.43, 0, 0}), CameraConfig{}, test::arena(), 1);
  world.step();
  EXPECT_TRUE(world.truth().crashed);
  EXPECT_FALSE(world.truth().on_board);
}

TEST(World, DrivingIntoACrateIsSeen) {
  WorldConfig config;
  config.start_from_tag_m = {0, 0, 2};
  config.ugv.course = {{4.0, -1.6, 0.5, CoursePhase::straight},
                       {7.0, -1.6, 0.5, CoursePhase::straight}};
  World world(config, CameraConfig{}, test::arena(), 1);
  world.command(hover());
  fly(world, 4s, [&] { return world.truth().ugv_collided; });
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
