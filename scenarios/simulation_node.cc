#include "scenarios/simulation_node.h"

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

}  // namespace nightjar::scenarios
