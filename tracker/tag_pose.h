#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera_model.h"
#include "core/state.h"

namespace nightjar::tracker {

/// One pose that explains a tag's four corners. Tag axes: origin in the middle,
/// x towards its top edge, y to its left, z out of its face.
struct TagPoseSolution {
  Eigen::Isometry3d T_camera_tag = Eigen::Isometry3d::Identity();
  double error_px = 0;  ///< Root mean square distance of corner from projection, undistorted.
};

/// Corners in tag axes (m), in the order of core::TagDetection::corner_px.
std::array<Eigen::Vector3d, 4> tag_corners_m(double tag_size_m);

/// Both local minima of the corners' reprojection error, the better one first.
/// A flat square seen from afar looks nearly the same tilted either way; seen
/// squarely the two fall together and one is given. The lens's distortion is taken out of the
/// corners first. Empty for corners that no square in front of the camera can have (not
/// convex, mirrored, or where the lens shows nothing).
std::vector<TagPoseSolution> tag_poses(const core::TagDetection& detection,
                                       const core::CameraModel& camera, double tag_size_m);

}  // namespace nightjar::tracker
