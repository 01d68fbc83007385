#include "scenarios/mount.h"

#include <numbers>

#include "scenarios/scenario.h"

namespace nightjar::scenarios {
namespace {

/// The camera's axes as columns: picture's right, picture's down, along the view.
Eigen::Matrix3d looking_down() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, -1, 0,  //
      -1, 0, 0,               //
      0, 0, -1;
  return R_body_camera;
}

Eigen::AngleAxisd turn(double angle_deg, const Eigen::Vector3d& axis) {
  return {angle_deg * std::numbers::pi / 180.0, axis};
}

}  // namespace

Eigen::Isometry3d T_body_camera(const camera::MountConfig& mount) {
  const auto& [roll_deg, pitch_deg, yaw_deg] = mount.roll_pitch_yaw_deg;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(mount.p_body_camera_m.data());
  T.linear() =
      (turn(yaw_deg, Eigen::Vector3d::UnitZ()) * turn(pitch_deg, Eigen::Vector3d::UnitY()) *
       turn(roll_deg, Eigen::Vector3d::UnitX()))
          .toRotationMatrix() *
      looking_down();
  return T;
}

void check_mount(const Scenario& scenario) {
  const camera::MountConfig& mount = scenario.source.mount;
  const camera::MountConfig model;
  if (scenario.source.type != camera::SourceType::simulation ||
      (mount.p_body_camera_m == model.p_body_camera_m &&
       mount.roll_pitch_yaw_deg == model.roll_pitch_yaw_deg))
    return;
  throw ScenarioError(
      "source.mount differs from its defaults, allowed only with source.type = caer: the "
      "simulator's camera sits where the model says");
}

}  // namespace nightjar::scenarios
