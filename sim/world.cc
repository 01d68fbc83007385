#include "sim/world.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace nightjar::sim {
namespace {

const char* phase_name(CoursePhase phase) {
  for (const auto& [name, value] : kCoursePhases)
    if (value == phase) return name;
  return "?";
}

core::Time checked_step(double step_s) {
  const core::Time step = core::from_seconds(step_s);
  if (step.count() < 1 || std::abs(core::seconds(step) - step_s) > 1e-12)
    throw std::invalid_argument(
        fmt::format("timestep = {} s, allowed whole microseconds from 1", step_s));
  if (kImuInterval % step != core::Time(0))
    throw std::invalid_argument(fmt::format(
        "timestep = {} s, allowed whole parts of {} s, the interval of inertial samples", step_s,
        core::seconds(kImuInterval)));
  return step;
}

// MuJoCo's cameras look along -z with y up; ours along z with y down.
const Eigen::Matrix3d& R_mujoco_camera() {
  static const Eigen::Matrix3d R = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return R;
}

}  // namespace

World::World(const WorldConfig& config, const CameraConfig& camera,
             const std::filesystem::path& model_file, std::uint64_t seed, const ImuConfig& imu)
    : scene_(model_file),
      quadrotor_(config.quadrotor, scene_),
      autopilot_(config.autopilot, quadrotor_, seed),
      ugv_(config.ugv, scene_),
      camera_(scene_.id(mjOBJ_CAMERA, "dvs")),
      tag_site_(scene_.id(mjOBJ_SITE, "tag")),
      board_geom_(scene_.id(mjOBJ_GEOM, "board")),
      ugv_body_(ugv_.body()),
      foot_geoms_{scene_.id(mjOBJ_GEOM, "foot_1"), scene_.id(mjOBJ_GEOM, "foot_2"),
                  scene_.id(mjOBJ_GEOM, "foot_3"), scene_.id(mjOBJ_GEOM, "foot_4")},
      camera_model_(core::CameraModel::from_fovy({camera.width_px, camera.height_px},
                                                 camera.fovy_deg * std::numbers::pi / 180.0)),
      renderer_(scene_, camera_model_.size, config.renderer.supersampling),
      view_motion_(scene_),
      time_step_(checked_step(scene_.model()->opt.timestep)) {
  scene_.model()->cam_fovy[camera_] = camera.fovy_deg;
  setpoint_.thrust_m_s2 = gravity_m_s2();
  place_vehicles(config);
  autopilot_.observe(scene_, now_, 0.0);
  const mjtNum* gravity = scene_.model()->opt.gravity;
  imu_.emplace(imu, Eigen::Vector3d(gravity[0], gravity[1], gravity[2]), camera_motion(), seed);
}

double World::gravity_m_s2() const { return -scene_.model()->opt.gravity[2]; }

CameraMotion World::camera_motion() const {
  const Eigen::Isometry3d T = T_world_camera();
  return {Eigen::Quaterniond(T.linear()), scene_.velocity_at(quadrotor_.body(), T.translation())};
}

void World::place_vehicles(const WorldConfig& config) {
  const double ugv_height_m = scene_.T_world_body(ugv_body_).translation().z();
  const Eigen::Isometry3d T_world_ugv = ugv_.T_world_start(ugv_height_m);
  scene_.place("ugv", T_world_ugv);
  scene_.settle();

  Eigen::Isometry3d T_world_uav = T_world_ugv;  // same heading
  T_world_uav.translation() = scene_.T_world_site(tag_site_).translation() +
                              Eigen::Vector3d(config.start_from_tag_m.data());
  scene_.place("uav", T_world_uav);
  scene_.settle();
  setpoint_.q_world_body = Eigen::Quaterniond(T_world_uav.linear());
}

void World::step() {
  const double dt_s = core::seconds(time_step_);
  ugv_.drive(dt_s, scene_);
  quadrotor_.apply(autopilot_.control(setpoint_), dt_s, scene_);
  scene_.step();
  now_ += time_step_;
  autopilot_.observe(scene_, now_, dt_s);
  if (now_ % kImuInterval == core::Time(0)) imu_samples_.push_back(imu_->next(camera_motion()));
  note_contacts();
}

bool World::is_foot(int geom) const {
  return std::find(foot_geoms_.begin(), foot_geoms_.end(), geom) != foot_geoms_.end();
}

void World::note_contacts() {
  const mjModel& model = *scene_.model();
  const mjData& data = *scene_.data();
  on_board_ = false;
  for (int i = 0; i < data.ncon; ++i) {
    const int g1 = data.contact[i].geom1, g2 = data.contact[i].geom2;
    const int root1 = model.body_rootid[model.geom_bodyid[g1]];
    const int root2 = model.body_rootid[model.geom_bodyid[g2]];
    const bool uav = root1 == quadrotor_.body() || root2 == quadrotor_.body();
    const bool ugv = root1 == ugv_body_ || root2 == ugv_body_;
    const bool foot_on_board =
        (is_foot(g1) && g2 == board_geom_) || (is_foot(g2) && g1 == board_geom_);
    const bool floor = model.geom_type[g1] == mjGEOM_PLANE || model.geom_type[g2] == mjGEOM_PLANE;
    if (foot_on_board) on_board_ = true;
    if (uav && !foot_on_board) crashed_ = true;
    if (ugv && !uav && !floor) ugv_collided_ = true;
  }
}

Eigen::Isometry3d World::T_world_camera() const {
  Eigen::Isometry3d T = scene_.T_world_camera(camera_);
  T.linear() = T.linear() * R_mujoco_camera();
  return T;
}

Eigen::Isometry3d World::T_body_camera() const {
  return scene_.T_world_body(quadrotor_.body()).inverse() * T_world_camera();
}

core::Truth World::truth() const {
  core::Truth truth;
  const Eigen::Isometry3d T_world_body = scene_.T_world_body(quadrotor_.body());
  truth.t = truth.uav.t = now_;
  truth.uav.p_world_body_m = T_world_body.translation();
  truth.uav.q_world_body = Eigen::Quaterniond(T_world_body.linear());
  truth.uav.v_world_body_m_s = scene_.velocity_at(quadrotor_.body(), T_world_body.translation());
  truth.uav.omega_body_rad_s =
      T_world_body.linear().transpose() * scene_.omega_world(quadrotor_.body());
  truth.T_world_camera = T_world_camera();
  truth.T_world_tag = scene_.T_world_site(tag_site_);
  truth.v_world_tag_m_s = scene_.velocity_at(ugv_body_, truth.T_world_tag.translation());
  truth.turn_rate_rad_s = scene_.omega_world(ugv_body_).z();
  truth.course_phase = phase_name(ugv_.phase());
  truth.on_board = on_board_;
  truth.crashed = crashed_;
  truth.ugv_collided = ugv_collided_;
  return truth;
}

double World::image_motion_px_s() const {
  const int uav = quadrotor_.body();
  const Eigen::Isometry3d T = T_world_camera();
  const MovingCamera camera{T, scene_.velocity_at(uav, T.translation()), scene_.omega_world(uav)};
  return view_motion_.fastest_px_s(scene_, camera_model_, camera);
}

void World::draw_chase(core::Image<Rgb>& view) {
  const Eigen::Vector3d tag = scene_.T_world_site(tag_site_).translation();
  const Eigen::Vector3d uav = scene_.T_world_body(quadrotor_.body()).translation();
  const Eigen::Vector3d middle = 0.5 * (tag + uav);
  const Eigen::Vector3d forward = scene_.T_world_body(ugv_body_).linear().col(0);
  const double heading_deg = std::atan2(forward.y(), forward.x()) * 180.0 / std::numbers::pi;
  // Follows the heading softly, so that turns do not swing the picture.
  const double wanted_deg = heading_deg + 25.0;
  if (!chase_started_) chase_azimuth_deg_ = wanted_deg;
  chase_started_ = true;
  chase_azimuth_deg_ += 0.02 * std::remainder(wanted_deg - chase_azimuth_deg_, 360.0);
  if (!chase_ || chase_->size() != view.size()) chase_.emplace(scene_, view.size());
  chase_->draw(scene_, {middle.x(), middle.y(), middle.z()}, 2.6, chase_azimuth_deg_, -25.0, view);
}

}  // namespace nightjar::sim
