#pragma once

#include "core/state.h"
#include "msg/bus.h"
#include "sim/simulation.h"

namespace nightjar::scenarios {

/// Setpoints in; truth, vehicle state, IMU samples, frames and events out.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class SimulationNode {
 public:
  SimulationNode(msg::Bus& bus, sim::Simulation& simulation);

  /// Fixes the setpoint to fly next: the last that came.
  void take_setpoint() { flown_ = latest_; }
  /// Flies one packet under it. Touches no bus.
  void fly() { simulation_.fly(flown_); }
  /// Publishes what the earliest packet flown and not yet published gave. Truth and
  /// vehicle state go first: whoever handles the picture made of the events has them by
  /// then. Returns the number of events.
  std::size_t publish();

 private:
  msg::Bus& bus_;
  sim::Simulation& simulation_;
  core::AttitudeSetpoint latest_;
  core::AttitudeSetpoint flown_;
};

}  // namespace nightjar::scenarios
