#include "sim/quadrotor.h"

#include <mujoco/mujoco.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string>

namespace nightjar::sim {

Quadrotor::Quadrotor(const QuadrotorConfig& config, const Scene& scene)
    : config_(config),
      body_(scene.id(mjOBJ_BODY, "uav")),
      mass_kg_(scene.model()->body_mass[body_]) {
  const mjModel& model = *scene.model();
  const mjtNum* inertia = model.body_inertia + 3 * body_;
  inertia_kg_m2_ = {inertia[0], inertia[1], inertia[2]};
  for (int i = 0; i < kRotors; ++i) {
    actuator_[i] = scene.id(mjOBJ_ACTUATOR, "rotor_" + std::to_string(i + 1));
    const mjtNum* place = model.site_pos + 3 * model.actuator_trnid[2 * actuator_[i]];
    const mjtNum* gear = model.actuator_gear + 6 * actuator_[i];
    // Thrust f along z at place r: torque r x (0, 0, f), and drag torque about z.
    wrench_from_thrusts_.col(i) << gear[2], place[1] * gear[2], -place[0] * gear[2], gear[5];
  }
  thrusts_from_wrench_ = wrench_from_thrusts_.inverse();

  const double hover_n = mass_kg_ * -model.opt.gravity[2] / kRotors;
  speed_.fill(std::sqrt(hover_n / config_.max_rotor_thrust_n));
}

Quadrotor::Thrusts Quadrotor::allocate(double collective_n, const Eigen::Vector3d& torque) const {
  const double most_n = config_.max_rotor_thrust_n;
  const Eigen::Vector4d without_yaw =
      (thrusts_from_wrench_ * Eigen::Vector4d(collective_n, torque.x(), torque.y(), 0.0))
          .cwiseMax(0.0)
          .cwiseMin(most_n);
  const Eigen::Vector4d yaw = thrusts_from_wrench_.col(3) * torque.z();
  double share = 1.0;  // heading matters least for staying in the air
  for (int i = 0; i < kRotors; ++i) {
    const double room_n = yaw[i] > 0 ? most_n - without_yaw[i] : without_yaw[i];
    if (std::abs(yaw[i]) > room_n) share = std::min(share, room_n / std::abs(yaw[i]));
  }
  const Eigen::Vector4d thrusts = without_yaw + share * yaw;
  return {thrusts[0], thrusts[1], thrusts[2], thrusts[3]};
}

void Quadrotor::apply(const Thrusts& command_n, double dt_s, Scene& scene) {
  const double blend = 1.0 - std::exp(-dt_s / config_.motor_time_constant_s);
  for (int i = 0; i < kRotors; ++i) {
    const double wanted =
        std::sqrt(std::clamp(command_n[i] / config_.max_rotor_thrust_n, 0.0, 1.0));
    speed_[i] += blend * (wanted - speed_[i]);
    scene.data()->ctrl[actuator_[i]] = config_.max_rotor_thrust_n * speed_[i] * speed_[i];
  }
  const Eigen::Isometry3d T_world_body = scene.T_world_body(body_);
  const Eigen::Vector3d v_body =
      T_world_body.linear().transpose() * scene.velocity_at(body_, T_world_body.translation());
  const Eigen::Vector3d drag_body(-config_.drag_xy_n_s_m * v_body.x(),
                                  -config_.drag_xy_n_s_m * v_body.y(),
                                  -config_.drag_z_n_s_m * v_body.z());
  const Eigen::Vector3d drag_world = T_world_body.linear() * drag_body;
  mju_copy3(scene.data()->xfrc_applied + 6 * body_, drag_world.data());
}

}  // namespace nightjar::sim
