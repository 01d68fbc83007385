#include "sim/image_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace nightjar::sim {
namespace {

const core::CameraModel kCamera{{346, 260}, 300, 300, 172.5, 129.5};

/// Looks straight down from 2 m, x along world x.
MovingCamera looking_down() {
  MovingCamera camera{Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(),
                      Eigen::Vector3d::Zero()};
  camera.T_world_camera.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.T_world_camera.translation().z() = 2;
  return camera;
}

/// A level slab whose top lies at `top_m`, wider than any view.
MovingBox slab(double top_m) {
  MovingBox box{Eigen::Isometry3d::Identity(), {50, 50, 0.05}};
  box.T_world_box.translation().z() = top_m - 0.05;
  return box;
}

TEST(ImageMotion, velocity_is_the_derivative_of_the_projection) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.4, -0.3, 0.2};
  camera.omega_world_rad_s = {0.5, -0.7, 0.9};
  const Eigen::Vector3d p(0.3, 0.4, 0.1), v(-0.2, 0.6, 0.1);
  const auto pixel_after = [&](double dt_s) {
    Eigen::Isometry3d T = camera.T_world_camera;
    const double angle = dt_s * camera.omega_world_rad_s.norm();
    T.linear() = Eigen::AngleAxisd(angle, camera.omega_world_rad_s.normalized()) * T.linear();
    T.translation() += dt_s * camera.v_world_m_s;
    return *kCamera.project(T.inverse() * (p + dt_s * v));
  };
  constexpr double kStep_s = 1e-5;
  const Eigen::Vector2d numeric = (pixel_after(kStep_s) - pixel_after(-kStep_s)) / (2 * kStep_s);
  // Central differences: error of order step^2, far below 1e-4 px/s here.
  EXPECT_LT((*image_velocity(kCamera, camera, p, v) - numeric).norm(), 1e-4);
}

TEST(MotionBound, sideways_flight_moves_the_floor_by_focal_length_over_height) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0, 0};
  EXPECT_NEAR(motion_bound_px_s(kCamera, camera, slab(0)), 300 * 0.5 / 2, 1e-9);
}

TEST(MotionBound, yaw_moves_the_corners_most) {
  MovingCamera camera = looking_down();
  camera.omega_world_rad_s = {0, 0, 2};
  EXPECT_NEAR(motion_bound_px_s(kCamera, camera, slab(0)), 2 * std::hypot(172.5, 129.5), 1e-9);
}

TEST(MotionBound, a_box_that_moves_along_stands_still) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0.2, 0};
  MovingBox box = slab(0.3);
  box.v_world_m_s = camera.v_world_m_s;
  EXPECT_NEAR(motion_bound_px_s(kCamera, camera, box), 0.0, 1e-9);
}

TEST(MotionBound, what_is_not_in_the_picture_does_not_count) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0.2, 0.1};
  camera.omega_world_rad_s = {0.1, 0.2, 0.3};
  EXPECT_EQ(motion_bound_px_s(kCamera, camera, slab(2.5)), 0.0) << "above the camera";
  MovingBox aside{Eigen::Isometry3d::Identity(), {0.2, 0.2, 0.2}};
  aside.T_world_box.translation() << 2.0, 0, 0.2;  // the picture ends at 1.15 m on the floor
  EXPECT_EQ(motion_bound_px_s(kCamera, camera, aside), 0.0);
  aside.T_world_box.translation().x() = 1.2;
  EXPECT_GT(motion_bound_px_s(kCamera, camera, aside), 0.0);
}

TEST(MotionBound, a_camera_within_the_box_has_no_bound) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0, 0};
  MovingBox around{Eigen::Isometry3d::Identity(), {3, 3, 3}};
  EXPECT_TRUE(std::isinf(motion_bound_px_s(kCamera, camera, around)));
}

// Random cameras look at random turning boxes from outside; random points of the boxes
// are followed. The grid may miss the extreme between its lines by a little: measured
// over these draws, no point exceeds the bound by more than 1 %.
TEST(MotionBound, no_point_of_the_box_in_view_is_faster) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-1, 1);
  const auto draw = [&](double scale) -> Eigen::Vector3d {
    return scale * Eigen::Vector3d(within(random), within(random), within(random));
  };
  int seen = 0;
  for (int trial = 0; trial < 300; ++trial) {
    MovingCamera camera = looking_down();
    camera.T_world_camera.linear() = Eigen::AngleAxisd(0.5 * within(random), draw(1).normalized()) *
                                     camera.T_world_camera.linear();
    camera.v_world_m_s = draw(1);
    camera.omega_world_rad_s = draw(1);
    MovingBox box{Eigen::Isometry3d::Identity(), {0.3, 0.4, 0.5}};
    box.T_world_box.linear() =
        Eigen::AngleAxisd(3 * within(random), draw(1).normalized()).toRotationMatrix();
    box.T_world_box.translation() = draw(1);
    box.v_world_m_s = draw(1);
    box.omega_world_rad_s = draw(3);
    const double bound = motion_bound_px_s(kCamera, camera, box);
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d p = box.T_world_box * draw(1).cwiseProduct(box.half_size_m);
      const auto pixel = kCamera.project(camera.T_world_camera.inverse() * p);
      if (!pixel || !kCamera.contains(*pixel)) continue;
      ++seen;
      const Eigen::Vector3d v =
          box.v_world_m_s + box.omega_world_rad_s.cross(p - box.T_world_box.translation());
      EXPECT_LE(image_velocity(kCamera, camera, p, v)->norm(), 1.01 * bound) << trial;
    }
  }
  EXPECT_GT(seen, 10000);
}

}  // namespace
}  // namespace nightjar::sim
