#pragma once

#include <Eigen/Core>

#include "core/event.h"

namespace nightjar::core {

/// What an inertial sensor felt on average over the interval that ends at `t`, in the
/// camera's axes: x right, y down, z forward (docs/frames.md).
struct ImuSample {
  Time t{};
  Eigen::Vector3d omega_camera_rad_s = Eigen::Vector3d::Zero();
  /// Acceleration minus gravity: at rest 9.81 upwards, in free fall none.
  Eigen::Vector3d specific_force_camera_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace nightjar::core
