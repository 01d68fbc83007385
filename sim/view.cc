#include "sim/view.h"

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>

namespace nightjar::sim {
namespace {

constexpr int kMaxGeoms = 500;
constexpr int kGroupUav = 1;

void update(const mjModel& model, mjData& data, mjvCamera& camera, bool with_uav, mjvScene& geoms) {
  mjvOption option;
  mjv_defaultOption(&option);
  for (int group = 0; group < mjNGROUP; ++group)
    option.geomgroup[group] = group == View::kSensorGroup || (with_uav && group == kGroupUav);
  mjv_updateScene(&model, &data, &option, nullptr, &camera, mjCAT_ALL, &geoms);
}

/// Nearest first, so that what it hides need not be shaded. The picture is the same.
void sort(mjvScene& geoms) {
  const Eigen::Map<const Eigen::Vector3f> eye(geoms.camera[0].pos);
  const auto distance = [&eye](const mjvGeom& geom) {
    return (Eigen::Map<const Eigen::Vector3f>(geom.pos) - eye).squaredNorm();
  };
  std::stable_sort(geoms.geoms, geoms.geoms + geoms.ngeom,
                   [&](const mjvGeom& a, const mjvGeom& b) { return distance(a) < distance(b); });
}

}  // namespace

void View::Delete::operator()(mjvScene* geoms) const {
  mjv_freeScene(geoms);
  delete geoms;
}

View::View(const Scene& scene) : geoms_(new mjvScene) {
  mjv_defaultScene(geoms_.get());
  mjv_makeScene(scene.model(), geoms_.get(), kMaxGeoms);
  for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_HAZE, mjRND_FOG})
    geoms_->flags[flag] = 0;
}

void View::look(Scene& scene, int camera_id, double ago_s) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FIXED;
  camera.fixedcamid = camera_id;
  update(*scene.model(), ago_s > 0 ? *scene.moment(ago_s) : *scene.data(), camera, false, *geoms_);
  sort(*geoms_);
}

void View::look_at(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
                   double azimuth_deg, double elevation_deg) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FREE;
  std::copy(look_at_m.begin(), look_at_m.end(), camera.lookat);
  camera.distance = distance_m;
  camera.azimuth = azimuth_deg;
  camera.elevation = elevation_deg;
  update(*scene.model(), *scene.data(), camera, true, *geoms_);
}

}  // namespace nightjar::sim
