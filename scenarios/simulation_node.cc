#include "scenarios/simulation_node.h"

#include "msg/channels.h"

namespace nightjar::scenarios {

SimulationNode::SimulationNode(msg::Bus& bus, sim::Simulation& simulation)
    : bus_(bus), simulation_(simulation) {
  latest_.q_world_body = simulation.world().vehicle_state().q_world_body;
  latest_.thrust_m_s2 = simulation.world().gravity_m_s2();  // hovers
  bus.subscribe(msg::kAttitudeSetpoint,
                [this](const core::AttitudeSetpoint& setpoint) { latest_ = setpoint; });
}

std::size_t SimulationNode::publish() {
  const sim::SimulationStep step = simulation_.take();
  bus_.publish(msg::kTruth, step.truth);
  bus_.publish(msg::kVehicleState, step.vehicle);
  for (const core::ImuSample& sample : step.imu) bus_.publish(msg::kImu, sample);
  for (const core::ApsFrame& frame : step.frames) bus_.publish(msg::kApsFrame, frame);
  bus_.publish(msg::kEvents, step.packet);
  return step.packet.events.size();
}

}  // namespace nightjar::scenarios
