#include "scenarios/record_node.h"

#include <utility>

#include "msg/channels.h"

namespace nightjar::scenarios {

RecordNode::RecordNode(msg::Bus& bus, OnRecord on_record) : on_record_(std::move(on_record)) {
  bus.subscribe(msg::kTruth, [this](const core::Truth& truth) { record_.truth = truth; });
  bus.subscribe(msg::kVehicleState,
                [this](const core::VehicleState& state) { record_.vehicle = state; });
  bus.subscribe(msg::kTagDetections, [this](const msg::TagDetections& detections) {
    record_.detections = detections.tags;
  });
  bus.subscribe(msg::kTargetEstimate,
                [this](const core::TargetEstimate& estimate) { record_.estimate = estimate; });
  bus.subscribe(msg::kMissionTransition, [this](const core::MissionTransition& transition) {
    record_.mission_phase = transition.to;
  });
  bus.subscribe(msg::kAttitudeSetpoint,
                [this](const core::AttitudeSetpoint&) { on_record_(record_); });
}

}  // namespace nightjar::scenarios
