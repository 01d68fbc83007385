#pragma once

#include <algorithm>
#include <cmath>

#include "core/state.h"

namespace nightjar::tracker {

/// A point mass with gravity and linear drag whose attitude follows the
/// setpoint as a first-order lag, and so does its thrust: what a quadrotor under
/// a good autopilot looks like from outside.
class Plant {
 public:
  core::VehicleState state;
  Eigen::Vector3d wind_m_s2 = Eigen::Vector3d::Zero();  ///< Constant push.
  double board_z_m = -1e3;                              ///< Stops here.
  static constexpr double kAttitude_s = 0.08;           ///< Time constant of the attitude.

  /// Moves on by `dt`, by steps of 1 ms.
  void fly(const core::AttitudeSetpoint& setpoint, core::Time dt) {
    for (core::Time t{}; t < dt; t += std::chrono::milliseconds(1)) step(setpoint, 1e-3);
  }

 private:
  void step(const core::AttitudeSetpoint& setpoint, double dt_s) {
    constexpr double kMotor_s = 0.03, kDrag_hz = 0.2;
    const double wanted = setpoint.motors_on ? setpoint.thrust_m_s2 : 0.0;
    thrust_m_s2_ += (wanted - thrust_m_s2_) * dt_s / kMotor_s;
    const Eigen::Quaterniond before = state.q_world_body;
    state.q_world_body = before.slerp(dt_s / kAttitude_s, setpoint.q_world_body);
    const Eigen::AngleAxisd turn(before.conjugate() * state.q_world_body);
    state.omega_body_rad_s = turn.angle() / dt_s * turn.axis();
    const Eigen::Vector3d a = state.q_world_body * Eigen::Vector3d(0, 0, thrust_m_s2_) -
                              Eigen::Vector3d(0, 0, 9.81) - kDrag_hz * state.v_world_body_m_s +
                              wind_m_s2;
    state.v_world_body_m_s += a * dt_s;
    state.p_world_body_m += state.v_world_body_m_s * dt_s;
    if (state.p_world_body_m.z() < board_z_m) {
      state.p_world_body_m.z() = board_z_m;
      state.v_world_body_m_s.z() = std::max(0.0, state.v_world_body_m_s.z());
    }
    state.t += core::from_seconds(dt_s);
  }

  double thrust_m_s2_ = 9.81;
};

}  // namespace nightjar::tracker
