#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/state.h"
#include "sim/config.h"
#include "sim/gauss_markov.h"
#include "sim/quadrotor.h"

namespace nightjar::sim {

/// The flight controller of the UAV: estimates its own state (truth plus stated
/// errors, AutopilotConfig) and holds the attitude and thrust it is asked for.
class Autopilot {
 public:
  Autopilot(const AutopilotConfig& config, const Quadrotor& quadrotor, std::uint64_t seed);

  /// Lets the errors evolve by `dt_s` and observes the scene at time `t`.
  void observe(const Scene& scene, core::Time t, double dt_s);

  /// The estimate as of the last observe().
  const core::VehicleState& state() const { return state_; }

  /// Rotor thrusts (N) that pull the estimated attitude towards the setpoint.
  Quadrotor::Thrusts control(const core::AttitudeSetpoint& setpoint) const;

 private:
  AutopilotConfig config_;
  const Quadrotor& quadrotor_;
  GaussMarkov position_error_m_;
  GaussMarkov velocity_error_m_s_;
  GaussMarkov attitude_error_rad_;  ///< rotation vector in world axes
  core::Random gyro_random_;
  core::VehicleState state_;
};

}  // namespace nightjar::sim
