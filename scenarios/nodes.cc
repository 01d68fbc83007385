#include "scenarios/nodes.h"

#include <utility>

#include "msg/channels.h"

namespace nightjar::scenarios {
namespace {

constexpr double kHover_m_s2 = 9.81;

}  // namespace

SimulationNode::SimulationNode(msg::Bus& bus, sim::Simulation& simulation)
    : bus_(bus), simulation_(simulation) {
  latest_.q_world_body = simulation.world().vehicle_state().q_world_body;
  latest_.thrust_m_s2 = kHover_m_s2;
  bus.subscribe(msg::kAttitudeSetpoint,
                [this](const core::AttitudeSetpoint& setpoint) { latest_ = setpoint; });
}

void SimulationNode::publish() {
  bus_.publish(msg::kTruth, step_.truth);
  bus_.publish(msg::kVehicleState, step_.vehicle);
  for (const core::ApsFrame& frame : step_.frames) bus_.publish(msg::kApsFrame, frame);
  bus_.publish(msg::kEvents, step_.packet);
}

ReconstructionNode::ReconstructionNode(msg::Bus& bus, const esi::EsiConfig& config,
                                       core::Resolution size)
    : esi_(config, size) {
  bus.subscribe(msg::kEvents, [this, &bus](const core::EventPacket& packet) {
    esi_.process(packet.events);
    esi_.render(packet.end, picture_);
    bus.publish(msg::kPicture, picture_);
  });
}

TrackerNode::TrackerNode(msg::Bus& bus, const tracker::TrackerConfig& config,
                         const core::CameraModel& camera, const Eigen::Isometry3d& T_body_camera)
    : tracker_(config, camera, T_body_camera) {
  bus.subscribe(msg::kVehicleState, [this](const core::VehicleState& state) {
    tracker_.add_vehicle_state(state);
  });
  bus.subscribe(msg::kPicture, [this, &bus](const core::Picture& picture) {
    const tracker::TrackerOutput output = tracker_.process(picture);
    bus.publish(msg::kTagDetections, {picture.t, output.detections});
    bus.publish(msg::kTargetEstimate, output.estimate);
    for (const core::MissionTransition& transition : output.transitions)
      bus.publish(msg::kMissionTransition, transition);
    bus.publish(msg::kAttitudeSetpoint, output.setpoint);
  });
}

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
