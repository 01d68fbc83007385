#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/state.h"
#include "tracker/config.h"

namespace nightjar::tracker {

/// What the controller is to fly: a point moving through the world.
struct FlightGoal {
  core::Time t{};
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_world_m_s2 = Eigen::Vector3d::Zero();
  std::optional<double> heading_rad;         ///< Nothing: keep the present heading.
  std::optional<double> height_above_tag_m;  ///< Of the vehicle; nothing if unknown.
  bool motors_on = true;
};

/// `goal` moved on by `dt_s` at its velocity and acceleration.
FlightGoal extrapolate(const FlightGoal& goal, double dt_s);

/// The mission's state machine:
///
///     search -> track -> descend -> land -> touched_down
///        ^________|_________|________|
///
/// A tag lost in track or descend is coasted over for a while, then searched
/// for. Landing goes on with the prediction; only a timeout or the end of the
/// prediction stops it. From touched_down nothing leads on.
class Mission {
 public:
  /// Throws std::invalid_argument for a config value out of range.
  explicit Mission(const MissionConfig& config);

  /// One step at the vehicle's time, later than the last one; the first begins
  /// the mission. `target` is the estimate for that same time. Returns the goal
  /// for that time.
  FlightGoal step(const core::VehicleState& vehicle, const core::TargetEstimate& target);

  core::MissionPhase phase() const { return phase_; }

  /// Transitions since the last call, oldest first.
  std::vector<core::MissionTransition> take_transitions();

 private:
  struct Relation;

  void decide(const Relation& now);
  void decide_track(const Relation& now);
  void decide_descend(const Relation& now);
  void decide_land(const Relation& now);
  bool lost(const Relation& now);
  bool held(bool condition, const Relation& now, double hold_s);
  void go(const Relation& now, core::MissionPhase to, std::string cause);

  FlightGoal search_goal(const core::VehicleState& vehicle, const core::TargetEstimate& target,
                         double dt_s);
  FlightGoal follow_goal(const core::TargetEstimate& target, const Relation& now, double dt_s);
  double height_rate_m_s(const Relation& now) const;

  MissionConfig config_;
  core::MissionPhase phase_ = core::MissionPhase::search;
  std::vector<core::MissionTransition> transitions_;
  std::optional<core::Time> begun_;
  core::Time last_step_{};
  core::Time phase_begun_{};
  std::optional<core::Time> held_since_;                       // the condition that ends the phase
  double goal_height_m_ = 0;                                   // above the tag, while following
  Eigen::Vector3d search_centre_m_ = Eigen::Vector3d::Zero();  // on the ground or the board
  double search_z_m_ = 0;
  double spiral_rad_ = 0;
};

}  // namespace nightjar::tracker
