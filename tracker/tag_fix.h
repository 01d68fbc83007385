#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera_model.h"
#include "core/event.h"
#include "tracker/config.h"
#include "tracker/tag_pose.h"

namespace nightjar::tracker {

/// Where a tag was in the world, as one picture and the UAV's own state say.
struct TagFix {
  core::Time t{};                                   ///< When the world looked like that.
  Eigen::Vector4d z = Eigen::Vector4d::Zero();      ///< x, y, z (m), heading (rad).
  Eigen::Matrix4d R = Eigen::Matrix4d::Identity();  ///< Covariance of z.
  double tilt_rad = 0;                              ///< Of the tag's normal from vertical.
};

/// The fix that follows from a pose solution for a camera at T_world_camera.
/// Nothing if the tag's normal is further from vertical than the config allows.
std::optional<TagFix> tag_fix(core::Time t, const TagPoseSolution& pose,
                              const Eigen::Isometry3d& T_world_camera,
                              const core::CameraModel& camera, double tag_size_m,
                              const MeasurementConfig& config);

}  // namespace nightjar::tracker
