#pragma once

#include "sim/config.h"
#include "sim/scene.h"

namespace nightjar::sim {

/// Drives the scene's UGV (two driven wheels, casters) along its course by pure
/// pursuit (Coulter, CMU-RI-TR-92-01). It knows its own pose: the UGV is part of
/// the world, not of the loop under test.
class Ugv {
 public:
  /// Throws std::invalid_argument when the scene lacks the body "ugv" or its
  /// wheels, or when two waypoints in a row coincide.
  Ugv(const UgvConfig& config, const Scene& scene);

  int body() const { return body_; }

  /// Ground pose at the start: the first waypoint, heading for the second.
  Eigen::Isometry3d T_world_start(double height_m) const;

  /// Sets the wheels' speeds for the next `dt_s`.
  void drive(double dt_s, Scene& scene);

  CoursePhase phase() const { return config_.course[leg_].phase; }
  bool finished() const { return finished_; }

 private:
  Eigen::Vector2d point(std::size_t i) const;
  Eigen::Vector2d pursue(const Eigen::Vector2d& p);

  UgvConfig config_;
  int body_;
  int wheel_left_, wheel_right_;  ///< actuators
  double wheel_radius_m_, track_m_;
  std::size_t leg_ = 0;  ///< from waypoint leg_ to leg_ + 1
  bool finished_ = false;
  double speed_m_s_ = 0;
};

}  // namespace nightjar::sim
