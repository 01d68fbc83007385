#pragma once

#include <Eigen/Geometry>

#include "core/camera_model.h"
#include "core/stage_timer.h"
#include "msg/bus.h"
#include "tracker/tracker.h"

namespace nightjar::scenarios {

/// Vehicle states and pictures in; detections, estimate, setpoint and steps of the
/// mission out, in that order.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class TrackerNode {
 public:
  TrackerNode(msg::Bus& bus, const tracker::TrackerConfig& config, const core::CameraModel& camera,
              const Eigen::Isometry3d& T_body_camera);

  const core::StageTime& stage_time() const { return tracking_.time(); }

 private:
  tracker::Tracker tracker_;
  core::StageTimer tracking_{"track", "loop"};
};

}  // namespace nightjar::scenarios
