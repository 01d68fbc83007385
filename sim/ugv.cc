#include "sim/ugv.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nightjar::sim {
namespace {

/// How far along the line from a to b the foot of p lies; 0 at a, 1 at b.
double progress(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (p - a).dot(b - a) / (b - a).squaredNorm();
}

}  // namespace

Ugv::Ugv(const UgvConfig& config, const Scene& scene)
    : config_(config),
      body_(scene.id(mjOBJ_BODY, "ugv")),
      wheel_left_(scene.id(mjOBJ_ACTUATOR, "wheel_left")),
      wheel_right_(scene.id(mjOBJ_ACTUATOR, "wheel_right")) {
  const mjModel& model = *scene.model();
  wheel_radius_m_ = model.geom_size[3 * scene.id(mjOBJ_GEOM, "tyre_left")];
  const auto wheel_y_m = [&](const char* name) {
    return model.body_pos[3 * scene.id(mjOBJ_BODY, name) + 1];
  };
  track_m_ = wheel_y_m("wheel_left") - wheel_y_m("wheel_right");
  for (std::size_t i = 1; i < config_.course.size(); ++i)
    if ((point(i) - point(i - 1)).norm() < 1e-3)
      throw std::invalid_argument(
          fmt::format("ugv.course[{}] lies on its predecessor, allowed at least 0.001 m apart", i));
}

Eigen::Vector2d Ugv::point(std::size_t i) const {
  return {config_.course[i].x_m, config_.course[i].y_m};
}

Eigen::Isometry3d Ugv::T_world_start(double height_m) const {
  const Eigen::Vector2d along = point(1) - point(0);
  return Eigen::Translation3d(point(0).x(), point(0).y(), height_m) *
         Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ());
}

/// Moves on to the leg that p has reached and returns the point one lookahead
/// ahead of p's foot along the course.
Eigen::Vector2d Ugv::pursue(const Eigen::Vector2d& p) {
  while (leg_ + 2 < config_.course.size() && progress(point(leg_), point(leg_ + 1), p) >= 1.0)
    ++leg_;
  double s = progress(point(leg_), point(leg_ + 1), p);
  finished_ = leg_ + 2 == config_.course.size() && s >= 1.0;

  double ahead_m = config_.lookahead_m;
  for (std::size_t i = leg_;; ++i, s = 0.0) {
    const Eigen::Vector2d along = point(i + 1) - point(i);
    const double left_m = (1.0 - s) * along.norm();
    if (ahead_m <= left_m || i + 2 == config_.course.size())
      return point(i) + (s + ahead_m / along.norm()) * along;
    ahead_m -= left_m;
  }
}

void Ugv::drive(double dt_s, Scene& scene) {
  const Eigen::Isometry3d T_world_body = scene.T_world_body(body_);
  const Eigen::Vector2d p = T_world_body.translation().head<2>();
  const Eigen::Vector2d goal = pursue(p);
  const Eigen::Vector2d forward = T_world_body.linear().col(0).head<2>().normalized();
  const Eigen::Vector2d to_goal = goal - p;
  const double sideways_m = forward.x() * to_goal.y() - forward.y() * to_goal.x();
  const double curvature_1_m = 2.0 * sideways_m / to_goal.squaredNorm();

  const double wanted_m_s = finished_ ? 0.0 : config_.course[leg_].speed_m_s;
  const double change = config_.max_acceleration_m_s2 * dt_s;
  speed_m_s_ = std::clamp(wanted_m_s, speed_m_s_ - change, speed_m_s_ + change);
  const double half_difference_m_s = 0.5 * track_m_ * curvature_1_m * speed_m_s_;
  scene.data()->ctrl[wheel_left_] = (speed_m_s_ - half_difference_m_s) / wheel_radius_m_;
  scene.data()->ctrl[wheel_right_] = (speed_m_s_ + half_difference_m_s) / wheel_radius_m_;
}

}  // namespace nightjar::sim
