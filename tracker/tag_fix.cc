#include "tracker/tag_fix.h"

#include <algorithm>
#include <cmath>

namespace nightjar::tracker {
namespace {

double squared(double v) { return v * v; }

}  // namespace

std::optional<TagFix> tag_fix(core::Time t, const TagPoseSolution& pose,
                              const Eigen::Isometry3d& T_world_camera,
                              const core::CameraModel& camera, double tag_size_m,
                              const MeasurementConfig& config) {
  const Eigen::Isometry3d T_world_tag = T_world_camera * pose.T_camera_tag;
  const double tilt_rad = std::acos(std::clamp(T_world_tag.linear()(2, 2), -1.0, 1.0));
  if (tilt_rad > config.max_tag_tilt_rad) return std::nullopt;

  const Eigen::Vector3d sight_m = T_world_camera.linear() * pose.T_camera_tag.translation();
  const double range_m = sight_m.norm();
  const Eigen::Vector3d along = sight_m / range_m;

  // Least squares over four corners, each with noise s in both axes. Seen
  // squarely, their mean has s / 2, and as much again comes from the tilt that
  // is fitted along: it shifts all four alike. Turn and scale of a square with
  // side a, its corners a / sqrt(2) from the middle, have s / (sqrt(2) a), the
  // range about sqrt(2) of that, since a tilt foreshortens.
  const double f_px = (camera.fx_px + camera.fy_px) / 2;
  const double side_px = f_px * tag_size_m / range_m;
  const double bearing_rad = config.corner_noise_px / (std::sqrt(2.0) * f_px);
  const double turn_rad = config.corner_noise_px / (std::sqrt(2.0) * side_px);
  const double across_m2 =
      squared(range_m) * (squared(bearing_rad) + squared(config.attitude_noise_rad));
  const double along_m2 = squared(range_m * std::sqrt(2.0) * turn_rad);

  TagFix fix{.t = t, .z = {}, .R = Eigen::Matrix4d::Zero(), .tilt_rad = tilt_rad};
  fix.z << T_world_tag.translation(),
      std::atan2(T_world_tag.linear()(1, 0), T_world_tag.linear()(0, 0));
  fix.R.topLeftCorner<3, 3>() =
      (across_m2 + squared(config.position_noise_m)) * Eigen::Matrix3d::Identity() +
      (along_m2 - across_m2) * along * along.transpose();
  fix.R(3, 3) = squared(turn_rad) + squared(config.heading_noise_rad);
  return fix;
}

}  // namespace nightjar::tracker
