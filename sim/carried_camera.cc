#include "sim/carried_camera.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace nightjar::sim {
namespace {

constexpr core::Time kLeastInterval{500};  // of the closed loop's physics step

// MuJoCo's cameras look along -z with y up; ours along z with y down.
Eigen::Isometry3d ours(Eigen::Isometry3d T_world_mujoco) {
  T_world_mujoco.linear() = T_world_mujoco.linear() * Eigen::Vector3d(1, -1, -1).asDiagonal();
  return T_world_mujoco;
}

/// Ahead of whatever is built from it.
template <class Config>
const Config& checked(const Config& config, const char* path) {
  core::check_config(config, path);
  return config;
}

double checked_lux(double illuminance_lux) {
  core::check_range("illuminance_lux", illuminance_lux, 0.1, 100000.0);
  return illuminance_lux;
}

}  // namespace

CarriedCamera::CarriedCamera(const CameraConfig& camera, const SensorConfig& sensor,
                             const RendererConfig& renderer,
                             const std::filesystem::path& model_file, double illuminance_lux,
                             CarryMotion motion, std::uint64_t seed)
    : renderer_config_(checked(renderer, "world.renderer")),
      illuminance_lux_(checked_lux(illuminance_lux)),
      packet_interval_(core::from_seconds(checked(camera, "camera").packet_interval_ms * 1e-3)),
      scene_(model_file),
      camera_id_(scene_.id(mjOBJ_CAMERA, "dvs")),
      tag_site_(scene_.id(mjOBJ_SITE, "tag")),
      model_(core::CameraModel::from_fovy({camera.width_px, camera.height_px},
                                          camera.fovy_deg * std::numbers::pi / 180.0)),
      renderer_(scene_, model_.size, renderer.supersampling),
      camera_(sensor, model_.size, illuminance_lux, seed),
      path_(motion, seed) {
  scene_.model()->cam_fovy[camera_id_] = camera.fovy_deg;
  scene_.settle();
  T_body_camera_ = scene_.T_world_body(scene_.id(mjOBJ_BODY, "uav")).inverse() *
                   ours(scene_.T_world_camera(camera_id_));
  render(now_);
}

Eigen::Isometry3d CarriedCamera::T_world_camera(core::Time t) const {
  return scene_.T_world_site(tag_site_) * path_.T_target_camera(t);
}

// The most that a grid of the picture's points, all taken to lie on the tag's plane, moves.
double CarriedCamera::motion_px(core::Time from, core::Time to) const {
  const Eigen::Isometry3d T_tag_before = path_.T_target_camera(from);
  const Eigen::Isometry3d T_after_tag = path_.T_target_camera(to).inverse();
  double most_px = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector2d pixel(0.5 * i * (model_.size.width_px - 1),
                                  0.5 * j * (model_.size.height_px - 1));
      const Eigen::Vector3d ray = T_tag_before.linear() * model_.ray(pixel);
      if (!(ray.z() < 0)) return std::numeric_limits<double>::infinity();
      const Eigen::Vector3d p_tag_m =
          T_tag_before.translation() - T_tag_before.translation().z() / ray.z() * ray;
      const auto moved = model_.project(T_after_tag * p_tag_m);
      if (!moved) return std::numeric_limits<double>::infinity();
      most_px = std::max(most_px, (*moved - pixel).norm());
    }
  return most_px;
}

core::Time CarriedCamera::next_render(core::Time packet_end) const {
  core::Time interval =
      std::min(core::from_seconds(renderer_config_.max_interval_ms * 1e-3), packet_end - now_);
  while (interval > kLeastInterval &&
         motion_px(now_, now_ + interval) > renderer_config_.max_motion_px)
    interval = std::max(kLeastInterval, interval * 3 / 4);
  return now_ + interval;
}

void CarriedCamera::render(core::Time t) {
  scene_.place("uav", T_world_camera(t) * T_body_camera_.inverse());
  scene_.settle();
  renderer_.draw(scene_, camera_id_, illuminance_lux_, luminance_lux_);
  camera_.expose(t, luminance_lux_);
  now_ = t;
}

CarriedStep CarriedCamera::next() {
  const core::Time packet_end = now_ + packet_interval_;
  while (now_ < packet_end) render(next_render(packet_end));
  CarriedStep step;
  CameraOutput output = camera_.take(now_);
  step.packet = std::move(output.packet);
  step.frames = std::move(output.frames);
  step.truth.t = now_;
  step.truth.T_world_camera = T_world_camera(now_);
  step.truth.T_world_tag = scene_.T_world_site(tag_site_);
  step.luminance_lux = luminance_lux_;
  return step;
}

}  // namespace nightjar::sim
