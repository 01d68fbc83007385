#include "sim/view_motion.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "sim/view.h"

namespace nightjar::sim {
namespace {

Eigen::Vector3d half_size_m(const mjModel& model, int geom) {
  const mjtNum* size = model.geom_size + 3 * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_BOX:
    case mjGEOM_ELLIPSOID: return {size[0], size[1], size[2]};
    case mjGEOM_SPHERE: return {size[0], size[0], size[0]};
    case mjGEOM_CYLINDER: return {size[0], size[0], size[1]};
    case mjGEOM_CAPSULE: return {size[0], size[0], size[0] + size[1]};
    case mjGEOM_PLANE: {
      // A size of 0 is endless: as far as anything is drawn, and then some.
      constexpr double kEndless_m = 1e3;
      return {size[0] > 0 ? size[0] : kEndless_m, size[1] > 0 ? size[1] : kEndless_m, 0};
    }
    default: return Eigen::Vector3d::Constant(model.geom_rbound[geom]);
  }
}

/// A plain ball or wheel looks the same however it has turned about its axis.
Eigen::Vector3d visible_turn(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  if (material >= 0 && model.mat_texid[material] >= 0) return {1, 1, 1};
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE: return {0, 0, 0};
    case mjGEOM_CYLINDER:
    case mjGEOM_CAPSULE: return {1, 1, 0};
    default: return {1, 1, 1};
  }
}

}  // namespace

ViewMotion::ViewMotion(const Scene& scene) {
  const mjModel& model = *scene.model();
  for (int geom = 0; geom < model.ngeom; ++geom)
    if (model.geom_group[geom] == View::kSensorGroup)
      parts_.push_back(
          {geom, model.geom_bodyid[geom], half_size_m(model, geom), visible_turn(model, geom)});
}

double ViewMotion::fastest_px_s(const Scene& scene, const core::CameraModel& model,
                                const MovingCamera& camera) const {
  double fastest = 0;
  for (const Part& part : parts_) {
    MovingBox box{scene.T_world_geom(part.geom), part.half_size_m};
    if (scene.model()->body_weldid[part.body] != 0) {  // 0: fixed to the world
      box.v_world_m_s = scene.velocity_at(part.body, box.T_world_box.translation());
      const Eigen::Matrix3d R_world_box = box.T_world_box.linear();
      box.omega_world_rad_s =
          R_world_box *
          part.visible_turn.cwiseProduct(R_world_box.transpose() * scene.omega_world(part.body));
    }
    fastest = std::max(fastest, motion_bound_px_s(model, camera, box));
  }
  return fastest;
}

}  // namespace nightjar::sim
