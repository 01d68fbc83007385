#include "sim/image_motion.h"

#include <gtest/gtest.h>

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

double fastest_of_floor(const MovingCamera& camera) {
  return fastest_motion_px_s(kCamera, camera, 0.0,
                             [](const Eigen::Vector3d&) { return Eigen::Vector3d::Zero(); });
}

TEST(ImageMotion, VelocityIsTheDerivativeOfTheProjection) {
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

TEST(ImageMotion, SidewaysFlightMovesTheFloorByFocalLengthOverHeight) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0, 0};
  EXPECT_NEAR(fastest_of_floor(camera), 300 * 0.5 / 2, 1e-9);
}

TEST(ImageMotion, YawMovesTheCornersMost) {
  MovingCamera camera = looking_down();
  camera.omega_world_rad_s = {0, 0, 2};
  EXPECT_NEAR(fastest_of_floor(camera), 2 * std::hypot(172.5, 129.5), 1e-9);
}

TEST(ImageMotion, APlaneThatMovesAlongStandsStill) {
  MovingCamera camera = looking_down();
  camera.v_world_m_s = {0.5, 0.2, 0};
  EXPECT_NEAR(fastest_motion_px_s(kCamera, camera, 0.3,
                                  [&](const Eigen::Vector3d&) { return camera.v_world_m_s; }),
              0.0, 1e-9);
}

TEST(ImageMotion, APlaneAboveTheCameraIsNotSeen) {
  EXPECT_EQ(fastest_motion_px_s(kCamera, looking_down(), 2.5,
                                [](const Eigen::Vector3d&) { return Eigen::Vector3d::Ones(); }),
            0.0);
}

}  // namespace
}  // namespace nightjar::sim
