#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/config.h"
#include "sim/scene.h"

namespace nightjar::sim {

/// Rotors with first-order speed lag (thrust goes with speed squared; the drag
/// torque follows from the MJCF's actuator gear) and linear body drag.
class Quadrotor {
 public:
  static constexpr int kRotors = 4;
  using Thrusts = std::array<double, kRotors>;

  /// Rotors start at hover speed. Throws std::invalid_argument when the scene
  /// lacks the body "uav" or an actuator rotor_1 to rotor_4.
  Quadrotor(const QuadrotorConfig& config, const Scene& scene);

  int body() const { return body_; }
  double mass_kg() const { return mass_kg_; }

  /// Thrusts (N) that give a collective thrust (N) and a torque (N m) in body
  /// axes, each held to what a rotor can do; torque about z gives way first.
  Thrusts allocate(double collective_n, const Eigen::Vector3d& torque_body_nm) const;

  /// Moments of inertia about the body axes, kg m^2.
  const Eigen::Vector3d& inertia_kg_m2() const { return inertia_kg_m2_; }

  /// Lets the rotors follow `command_n` over `dt_s` and applies thrust and drag to
  /// the scene, for its next step.
  void apply(const Thrusts& command_n, double dt_s, Scene& scene);

 private:
  QuadrotorConfig config_;
  int body_;
  std::array<int, kRotors> actuator_{};
  double mass_kg_;
  Eigen::Vector3d inertia_kg_m2_;
  Eigen::Matrix4d wrench_from_thrusts_;  ///< rows: collective, torque x, y, z
  Eigen::Matrix4d thrusts_from_wrench_;
  std::array<double, kRotors> speed_{};  ///< of full speed, 0 to 1
};

}  // namespace nightjar::sim
