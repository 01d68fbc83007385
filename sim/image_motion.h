#pragma once

#include <Eigen/Geometry>

#include "core/camera_model.h"

namespace nightjar::sim {

/// A camera pose (x right, y down, z forward) with its velocities in world axes.
struct MovingCamera {
  Eigen::Isometry3d T_world_camera;
  Eigen::Vector3d v_world_m_s;
  Eigen::Vector3d omega_world_rad_s;
};

/// Image velocity (px/s) of a world point that moves with `v_world_m_s`; nothing
/// when the point is not in front of the camera.
std::optional<Eigen::Vector2d> image_velocity(const core::CameraModel& model,
                                              const MovingCamera& camera,
                                              const Eigen::Vector3d& p_world_m,
                                              const Eigen::Vector3d& v_world_m_s);

/// The fastest image motion (px/s) of the level plane at `height_m`, which as a
/// whole moves like a rigid body: `plane_velocity(p)` is the velocity of its point
/// p. Looks at a grid of pixels over the picture; those that look past the plane
/// are left out.
template <class PlaneVelocity>
double fastest_motion_px_s(const core::CameraModel& model, const MovingCamera& camera,
                           double height_m, PlaneVelocity plane_velocity) {
  constexpr int kGrid = 4;  // image motion of a plane is quadratic in x and y: its extremes
                            // are at the rim
  double fastest = 0;
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      const Eigen::Vector2d pixel(i * (model.size.width_px - 1.0) / kGrid,
                                  j * (model.size.height_px - 1.0) / kGrid);
      const Eigen::Vector3d ray = camera.T_world_camera.linear() * model.ray(pixel);
      const double above_m = camera.T_world_camera.translation().z() - height_m;
      if (ray.z() >= 0 || above_m <= 0) continue;
      const Eigen::Vector3d p = camera.T_world_camera.translation() - ray * (above_m / ray.z());
      if (const auto v = image_velocity(model, camera, p, plane_velocity(p)))
        fastest = std::max(fastest, v->norm());
    }
  return fastest;
}

}  // namespace nightjar::sim
