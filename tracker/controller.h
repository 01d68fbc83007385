#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/state.h"
#include "tracker/config.h"
#include "tracker/mission.h"

namespace nightjar::tracker {

/// Position -> velocity -> acceleration -> attitude and thrust. The inner
/// attitude and rate loops are the autopilot's.
class Controller {
 public:
  /// Throws std::invalid_argument for a config value out of range.
  explicit Controller(const ControllerConfig& config);

  /// The setpoint that brings the vehicle to the goal; both hold for the
  /// vehicle's time, later than that of the last call.
  core::AttitudeSetpoint step(const core::VehicleState& vehicle, const FlightGoal& goal);

  /// The small tilt, turning round like a cone's side, that is put on top of
  /// the attitude at `t` and at this height above the tag.
  Eigen::Quaterniond dither(core::Time t, std::optional<double> height_above_tag_m) const;

 private:
  Eigen::Vector3d thrust(const core::VehicleState& vehicle, const FlightGoal& goal, double dt_s);
  double heading(const FlightGoal& goal, double dt_s) const;

  ControllerConfig config_;
  std::optional<core::Time> last_step_;
  Eigen::Vector3d integral_m_s2_ = Eigen::Vector3d::Zero();
  double heading_rad_ = 0;
};

/// The attitude whose body z lies along `thrust_m_s2` (upwards) and whose body
/// x looks as near as it can to `heading_rad`.
Eigen::Quaterniond attitude(const Eigen::Vector3d& thrust_m_s2, double heading_rad);

}  // namespace nightjar::tracker
