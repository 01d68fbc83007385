#include "sim/image_motion.h"

#include <algorithm>
#include <array>
#include <limits>

namespace nightjar::sim {
namespace {

using Corners = std::array<Eigen::Vector3d, 8>;

/// The box's corners in camera axes.
Corners corners_camera(const MovingCamera& camera, const MovingBox& box) {
  const Eigen::Isometry3d T_camera_box = camera.T_world_camera.inverse() * box.T_world_box;
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    corners[i] = T_camera_box * side.cwiseProduct(box.half_size_m);
  }
  return corners;
}

/// Whether all corners lie beyond one side of the picture, or behind the camera.
bool out_of_view(const core::CameraModel& model, const Corners& corners) {
  const Eigen::Vector3d first = model.ray({-0.5, -0.5});
  const Eigen::Vector3d last = model.ray({model.size.width_px - 0.5, model.size.height_px - 0.5});
  const auto all = [&corners](auto beyond) {
    return std::all_of(corners.begin(), corners.end(), beyond);
  };
  return all([&](const Eigen::Vector3d& p) { return p.x() < first.x() * p.z(); }) ||
         all([&](const Eigen::Vector3d& p) { return p.x() > last.x() * p.z(); }) ||
         all([&](const Eigen::Vector3d& p) { return p.y() < first.y() * p.z(); }) ||
         all([&](const Eigen::Vector3d& p) { return p.y() > last.y() * p.z(); }) ||
         all([&](const Eigen::Vector3d& p) { return p.z() <= 0; });
}

/// How far the camera is from the box; 0 inside.
double distance_m(const MovingCamera& camera, const MovingBox& box) {
  const Eigen::Vector3d p = box.T_world_box.inverse() * camera.T_world_camera.translation();
  return (p.cwiseAbs() - box.half_size_m).cwiseMax(0.0).norm();
}

struct PixelRange {
  Eigen::Vector2d first, last;
};

/// The part of the picture in which the box can appear.
PixelRange seen_in(const core::CameraModel& model, const Corners& corners) {
  const Eigen::Vector2d end(model.size.width_px - 1.0, model.size.height_px - 1.0);
  PixelRange range{end, Eigen::Vector2d::Zero()};
  for (const Eigen::Vector3d& p : corners) {
    const auto pixel = model.project(p);
    if (!pixel) return {Eigen::Vector2d::Zero(), end};  // it reaches behind the camera
    range.first = range.first.cwiseMin(*pixel);
    range.last = range.last.cwiseMax(*pixel);
  }
  return {range.first.cwiseMax(0.0), range.last.cwiseMin(end)};
}

double top_m(const MovingBox& box) {
  const Eigen::RowVector3d up = box.T_world_box.linear().row(2);
  return box.T_world_box.translation().z() + up.cwiseAbs().dot(box.half_size_m);
}

/// The least depth (along the optical axis) that a point of the box can have where the
/// ray (camera axes, z = 1) looks; nothing where it cannot see any.
std::optional<double> least_depth_m(const MovingCamera& camera, const Eigen::Vector3d& ray,
                                    double top_of_box_m, double distance_of_box_m) {
  double least = distance_of_box_m / ray.norm();
  const double above_m = camera.T_world_camera.translation().z() - top_of_box_m;
  if (above_m <= 0) return least;
  // From above, a ray meets nothing of the box before it has sunk to the box's top.
  const double sinks = -(camera.T_world_camera.linear() * ray).z();
  if (sinks <= 0) return std::nullopt;
  return std::max(least, above_m / sinks);
}

}  // namespace

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

double motion_bound_px_s(const core::CameraModel& model, const MovingCamera& camera,
                         const MovingBox& box) {
  const Corners corners = corners_camera(camera, box);
  if (out_of_view(model, corners)) return 0;
  const double distance = distance_m(camera, box);
  if (distance <= 0) return std::numeric_limits<double>::infinity();
  const double top = top_m(box);
  const double farthest = std::max_element(corners.begin(), corners.end(), [](auto& a, auto& b) {
                            return a.z() < b.z();
                          })->z();
  double bound = 0;
  const auto try_depth = [&](const Eigen::Vector3d& ray, double depth_m) {
    const Eigen::Vector3d p = camera.T_world_camera * (ray * depth_m);
    const Eigen::Vector3d v =
        box.v_world_m_s + box.omega_world_rad_s.cross(p - box.T_world_box.translation());
    if (const auto motion = image_velocity(model, camera, p, v))
      bound = std::max(bound, motion->norm());
  };
  const PixelRange seen = seen_in(model, corners);
  constexpr int kGrid = 4;
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      const Eigen::Vector2d share(i / double{kGrid}, j / double{kGrid});
      const Eigen::Vector3d ray =
          model.ray(seen.first + share.cwiseProduct(seen.last - seen.first));
      const auto least = least_depth_m(camera, ray, top, distance);
      if (!least || *least > farthest) continue;
      // Along a ray, image velocity is linear in 1/depth: its norm is greatest at an end.
      try_depth(ray, *least);
      try_depth(ray, farthest);
    }
  return bound;
}

}  // namespace nightjar::sim
