#pragma once

#include <array>

#include "core/config_check.h"

namespace nightjar::camera {

/// Where a real camera sits on the vehicle, in body axes: x forward, y left, z up
/// (docs/frames.md). The defaults are the simulated vehicle's.
struct MountConfig {
  std::array<double, 3> p_body_camera_m = {0.0, 0.0, -0.055};  ///< Its optical centre.
  /// Out of looking straight down with the picture's top towards the nose: turned about the
  /// body's x, then y, then z axis, by the right-hand rule.
  std::array<double, 3> roll_pitch_yaw_deg = {0.0, 0.0, 0.0};

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("p_body_camera_m", p_body_camera_m, -10.0, 10.0, {"models/arena.xml"});
    v.field("roll_pitch_yaw_deg", roll_pitch_yaw_deg, -180.0, 180.0, {"models/arena.xml"});
  }
};

}  // namespace nightjar::camera
