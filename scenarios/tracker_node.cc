#include "scenarios/tracker_node.h"

#include "msg/channels.h"

namespace nightjar::scenarios {

TrackerNode::TrackerNode(msg::Bus& bus, const tracker::TrackerConfig& config,
                         const core::CameraModel& camera, const Eigen::Isometry3d& T_body_camera)
    : tracker_(config, camera, T_body_camera) {
  bus.subscribe(msg::kVehicleState,
                [this](const core::VehicleState& state) { tracker_.add_vehicle_state(state); });
  bus.subscribe(msg::kPicture, [this, &bus](const core::Picture& picture) {
    const tracker::TrackerOutput output = tracking_([&] { return tracker_.process(picture); });
    bus.publish(msg::kTagDetections, {picture.t, output.detections});
    bus.publish(msg::kTargetEstimate, output.estimate);
    for (const core::MissionTransition& transition : output.transitions)
      bus.publish(msg::kMissionTransition, transition);
    bus.publish(msg::kAttitudeSetpoint, output.setpoint);
  });
}

}  // namespace nightjar::scenarios
