#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/camera_model.h"

namespace nightjar::sim {

/// A camera pose (x right, y down, z forward) with its velocities in world axes.
struct MovingCamera {
  Eigen::Isometry3d T_world_camera;
  Eigen::Vector3d v_world_m_s;
  Eigen::Vector3d omega_world_rad_s;
};

/// A box that moves as a rigid body; `v_world_m_s` is its centre's velocity.
struct MovingBox {
  Eigen::Isometry3d T_world_box;  ///< Origin in the centre, axes along the sides.
  Eigen::Vector3d half_size_m;
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_world_rad_s = Eigen::Vector3d::Zero();
};

/// Image velocity (px/s) of a world point that moves with `v_world_m_s`; nothing
/// when the point is not in front of the camera.
std::optional<Eigen::Vector2d> image_velocity(const core::CameraModel& model,
                                              const MovingCamera& camera,
                                              const Eigen::Vector3d& p_world_m,
                                              const Eigen::Vector3d& v_world_m_s);

/// An upper bound, to 1 %, of the image speed (px/s) of all points in the box that the
/// camera may see, whatever hides them; 0 when none is in the picture, infinite from within.
/// Looks at a grid over the pixels where the box can appear: image motion at a given
/// depth is quadratic in the pixel, so that its extremes are at the rim.
double motion_bound_px_s(const core::CameraModel& model, const MovingCamera& camera,
                         const MovingBox& box);

}  // namespace nightjar::sim
