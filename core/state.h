#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/event.h"

namespace nightjar::core {

/// The autopilot's estimate of the UAV. World axes: x east, y north, z up; body
/// axes: x forward, y left, z up (docs/frames.md).
struct VehicleState {
  Time t{};
  Eigen::Vector3d p_world_body_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_world_body_m_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_world_body = Eigen::Quaterniond::Identity();
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();

  Eigen::Isometry3d T_world_body() const {
    return Eigen::Translation3d(p_world_body_m) * q_world_body;
  }
};

/// One decoded tag in the picture made at `t`. Corners as AprilTag orders them:
/// seen upright, bottom left, bottom right, top right, top left of the black
/// square; pixel centres at whole numbers.
struct TagDetection {
  Time t{};
  int id = 0;
  int hamming = 0;
  double decision_margin = 0;
  std::array<Eigen::Vector2d, 4> corner_px = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                              Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

/// The UGV's motion as estimated for time `t`, in the world.
struct TargetEstimate {
  Time t{};
  bool valid = false;                                       ///< false before the first tag
  Eigen::Vector3d p_world_tag_m = Eigen::Vector3d::Zero();  ///< tag centre
  Eigen::Vector3d v_world_tag_m_s = Eigen::Vector3d::Zero();
  double heading_rad = 0;  ///< about world z, from x
  double turn_rate_rad_s = 0;
  Eigen::Vector3d sigma_p_m = Eigen::Vector3d::Zero();  ///< standard deviations
  Time last_tag{};                                      ///< picture of the last tag used
};

/// What the companion computer asks of the autopilot: an attitude and a
/// mass-specific collective thrust along body z (9.81 hovers).
struct AttitudeSetpoint {
  Time t{};
  Eigen::Quaterniond q_world_body = Eigen::Quaterniond::Identity();
  double thrust_m_s2 = 0;
  bool motors_on = true;
};

enum class MissionPhase { search, track, descend, land, touched_down };

/// Lower-case name of a phase, as logs and messages carry it.
const char* to_string(MissionPhase phase);

/// One step of the mission, with the reason it was taken.
struct MissionTransition {
  Time t{};
  MissionPhase from{};
  MissionPhase to{};
  std::string cause;
};

}  // namespace nightjar::core
