#include "tracker/controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tracker/angles.h"
#include "tracker/pause.h"

namespace nightjar::tracker {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kRad_deg = std::numbers::pi / 180;

double heading_of(const Eigen::Quaterniond& q_world_body) {
  const Eigen::Vector3d forward = q_world_body * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

/// `v`, its horizontal part no longer than `most`.
Eigen::Vector3d with_horizontal_limit(const Eigen::Vector3d& v, double most) {
  const double length = v.head<2>().norm();
  Eigen::Vector3d limited = v;
  if (length > most) limited.head<2>() *= most / length;
  return limited;
}

}  // namespace

Eigen::Quaterniond attitude(const Eigen::Vector3d& thrust_m_s2, double heading_rad) {
  const Eigen::Vector3d z = thrust_m_s2.normalized();
  const Eigen::Vector3d x_level(std::cos(heading_rad), std::sin(heading_rad), 0);
  const Eigen::Vector3d y = z.cross(x_level).normalized();
  Eigen::Matrix3d R_world_body;
  R_world_body << y.cross(z), y, z;
  return Eigen::Quaterniond(R_world_body);
}

Controller::Controller(const ControllerConfig& config) : config_(config) {
  core::check_config(config_, "controller");
}

core::AttitudeSetpoint Controller::step(const core::VehicleState& vehicle, const FlightGoal& goal) {
  if (!last_step_) {
    last_step_ = vehicle.t;
    heading_rad_ = heading_of(vehicle.q_world_body);
  }
  // After a pause, as when the camera was away, neither heading nor integral jumps.
  const double dt_s = core::seconds(std::min(vehicle.t - *last_step_, kPause));
  last_step_ = vehicle.t;

  core::AttitudeSetpoint setpoint{.t = vehicle.t,
                                  .q_world_body = attitude(Eigen::Vector3d::UnitZ(), heading_rad_),
                                  .thrust_m_s2 = 0,
                                  .motors_on = goal.motors_on};
  if (!goal.motors_on) return setpoint;
  heading_rad_ = heading(goal, dt_s);
  const Eigen::Vector3d f = thrust(vehicle, goal, dt_s);
  setpoint.thrust_m_s2 = f.norm();
  setpoint.q_world_body = attitude(f, heading_rad_) * dither(vehicle.t, goal.height_above_tag_m);
  return setpoint;
}

Eigen::Quaterniond Controller::dither(core::Time t,
                                      std::optional<double> height_above_tag_m) const {
  double tilt_rad = config_.dither_tilt_deg * kRad_deg;
  if (height_above_tag_m && *height_above_tag_m < config_.dither_taper_height_m)
    tilt_rad *= std::max(0.0, *height_above_tag_m) / config_.dither_taper_height_m;
  const double phase_rad = 2 * std::numbers::pi * config_.dither_rate_hz * core::seconds(t);
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(std::cos(phase_rad), std::sin(phase_rad), 0)));
}

/// Mass-specific thrust in world axes, within the limits of tilt and motors.
Eigen::Vector3d Controller::thrust(const core::VehicleState& vehicle, const FlightGoal& goal,
                                   double dt_s) {
  Eigen::Vector3d correction = with_horizontal_limit(
      config_.position_gain_hz * (goal.p_world_m - vehicle.p_world_body_m), config_.max_speed_m_s);
  correction.z() = std::clamp(correction.z(), -config_.max_climb_m_s, config_.max_climb_m_s);
  const Eigen::Vector3d error = goal.v_world_m_s + correction - vehicle.v_world_body_m_s;
  const Eigen::Vector3d wanted = goal.a_world_m_s2 + config_.velocity_gain_hz * error +
                                 integral_m_s2_ + Eigen::Vector3d(0, 0, kGravity_m_s2);

  Eigen::Vector3d f = wanted;
  f.z() = std::clamp(f.z(), config_.min_thrust_m_s2, config_.max_thrust_m_s2);
  f = with_horizontal_limit(f, f.z() * std::tan(config_.max_tilt_deg * kRad_deg));
  // Integrating while a limit holds would only wind up.
  if (f == wanted)
    integral_m_s2_ = (integral_m_s2_ + config_.velocity_integral_hz2 * dt_s * error)
                         .cwiseMax(-config_.max_integral_m_s2)
                         .cwiseMin(config_.max_integral_m_s2);
  return f;
}

/// Turns towards the goal's heading, the short way, at a limited rate.
double Controller::heading(const FlightGoal& goal, double dt_s) const {
  if (!goal.heading_rad) return heading_rad_;
  const double most = config_.max_yaw_rate_rad_s * dt_s;
  return wrapped(heading_rad_ + std::clamp(wrapped(*goal.heading_rad - heading_rad_), -most, most));
}

}  // namespace nightjar::tracker
