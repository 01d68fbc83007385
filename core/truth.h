#pragma once

#include <Eigen/Geometry>
#include <string>

#include "core/state.h"

namespace nightjar::core {

/// What really is, for scoring and plots only: no module of the loop under test
/// may include this file (tests/rules/include_rule_test.cc).
struct Truth {
  Time t{};
  VehicleState uav;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_tag = Eigen::Isometry3d::Identity();
  Eigen::Vector3d v_world_tag_m_s = Eigen::Vector3d::Zero();
  double turn_rate_rad_s = 0;
  std::string course_phase;   ///< of the UGV's course: straight, turning, landing
  bool on_board = false;      ///< UAV's feet touch the landing board
  bool crashed = false;       ///< UAV touches anything else
  bool ugv_collided = false;  ///< UGV touches an obstacle
};

}  // namespace nightjar::core
