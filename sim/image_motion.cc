#include "sim/image_motion.h"

namespace nightjar::sim {

std::optional<Eigen::Vector2d> image_velocity(const core::CameraModel& model,
                                              const MovingCamera& camera,
                                              const Eigen::Vector3d& p_world,
                                              const Eigen::Vector3d& v_world) {
  const Eigen::Vector3d from_camera = p_world - camera.T_world_camera.translation();
  const Eigen::Matrix3d R_camera_world = camera.T_world_camera.linear().transpose();
  const Eigen::Vector3d p = R_camera_world * from_camera;
  if (p.z() < 1e-6) return std::nullopt;
  const Eigen::Vector3d v =
      R_camera_world * (v_world - camera.v_world_m_s - camera.omega_world_rad_s.cross(from_camera));
  // d/dt of f x / z.
  return Eigen::Vector2d(model.fx_px * (v.x() * p.z() - p.x() * v.z()) / (p.z() * p.z()),
                         model.fy_px * (v.y() * p.z() - p.y() * v.z()) / (p.z() * p.z()));
}

}  // namespace nightjar::sim
