#include "sim/autopilot.h"

#include <cmath>
#include <numbers>

namespace nightjar::sim {
namespace {

Eigen::Quaterniond rotation(const Eigen::Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector_rad / angle));
}

constexpr double radians(double deg) { return deg * std::numbers::pi / 180.0; }

}  // namespace

Autopilot::Autopilot(const AutopilotConfig& c, const Quadrotor& quadrotor, std::uint64_t seed)
    : config_(c),
      quadrotor_(quadrotor),
      position_error_m_(Eigen::Vector3d::Constant(c.position_sigma_m), c.position_correlation_s,
                        core::random_stream(seed, "autopilot.position")),
      velocity_error_m_s_(Eigen::Vector3d::Constant(c.velocity_sigma_m_s), c.velocity_correlation_s,
                          core::random_stream(seed, "autopilot.velocity")),
      attitude_error_rad_(
          {radians(c.tilt_sigma_deg), radians(c.tilt_sigma_deg), radians(c.heading_sigma_deg)},
          c.attitude_correlation_s, core::random_stream(seed, "autopilot.attitude")),
      gyro_random_(core::random_stream(seed, "autopilot.gyro")) {}

void Autopilot::observe(const Scene& scene, core::Time t, double dt_s) {
  position_error_m_.advance(dt_s);
  velocity_error_m_s_.advance(dt_s);
  attitude_error_rad_.advance(dt_s);

  const int body = quadrotor_.body();
  const Eigen::Isometry3d T_world_body = scene.T_world_body(body);
  const Eigen::Vector3d p = T_world_body.translation();
  state_.t = t;
  state_.p_world_body_m = p + position_error_m_.value();
  state_.v_world_body_m_s = scene.velocity_at(body, p) + velocity_error_m_s_.value();
  state_.q_world_body =
      (rotation(attitude_error_rad_.value()) * Eigen::Quaterniond(T_world_body.linear()))
          .normalized();
  state_.omega_body_rad_s = T_world_body.linear().transpose() * scene.omega_world(body) +
                            config_.rate_sigma_rad_s * normal3(gyro_random_);
}

Quadrotor::Thrusts Autopilot::control(const core::AttitudeSetpoint& setpoint) const {
  if (!setpoint.motors_on) return {};
  Eigen::Quaterniond error = state_.q_world_body.conjugate() * setpoint.q_world_body;
  if (error.w() < 0) error.coeffs() *= -1;  // the short way round
  const Eigen::Vector3d rate_wanted = 2.0 * config_.attitude_gain_1_s * error.vec();
  const Eigen::Vector3d angular_acceleration =
      config_.rate_gain_1_s * (rate_wanted - state_.omega_body_rad_s);
  const Eigen::Vector3d& inertia = quadrotor_.inertia_kg_m2();
  const Eigen::Vector3d torque =
      inertia.cwiseProduct(angular_acceleration) +
      state_.omega_body_rad_s.cross(inertia.cwiseProduct(state_.omega_body_rad_s));
  return quadrotor_.allocate(quadrotor_.mass_kg() * setpoint.thrust_m_s2, torque);
}

}  // namespace nightjar::sim
