#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera_model.h"
#include "core/image.h"
#include "core/state.h"
#include "tracker/config.h"
#include "tracker/controller.h"
#include "tracker/ekf.h"
#include "tracker/mission.h"
#include "tracker/state_history.h"
#include "tracker/tag_detector.h"

namespace nightjar::tracker {

/// What one picture led to. All of it holds for the picture's time, save that
/// the setpoint looks ahead by the command delay.
struct TrackerOutput {
  std::vector<core::TagDetection> detections;  ///< Everything decoded, whatever its id.
  FixResult fix = FixResult::none;             ///< What the filter made of it.
  bool whole_picture = true;                   ///< Searched; else a window of it.
  core::TargetEstimate estimate;
  core::AttitudeSetpoint setpoint;
  core::MissionPhase phase{};
  std::vector<core::MissionTransition> transitions;
};

/// The companion computer: pictures and autopilot states in, setpoints out.
class Tracker {
 public:
  /// Throws std::invalid_argument for a config value out of range.
  Tracker(const TrackerConfig& config, const core::CameraModel& camera,
          const Eigen::Isometry3d& T_body_camera);

  /// Takes the autopilot's next estimate, each newer than the last.
  void add_vehicle_state(const core::VehicleState& state);

  /// Takes the next picture. Vehicle states up to its time should be in; throws
  /// std::invalid_argument if there is none at it or, by max_state_age_ms, shortly before,
  /// and for a picture that is not of the camera's size.
  TrackerOutput process(const core::Picture& picture);

 private:
  std::optional<Window> predicted_window(core::Time t,
                                         const Eigen::Isometry3d& T_world_camera) const;
  FixResult fuse(const std::vector<core::TagDetection>& detections, core::Time t,
                 const Eigen::Isometry3d& T_world_camera);
  core::TargetEstimate estimate_at(core::Time picture_t) const;

  TrackerConfig config_;
  core::CameraModel camera_;
  Eigen::Isometry3d T_body_camera_;
  StateHistory history_;
  TagDetector detector_;
  TargetEkf ekf_;
  Mission mission_;
  Controller controller_;
  int misses_ = 0;  // pictures in a row without a used tag
};

}  // namespace nightjar::tracker
