#pragma once

#include "core/state.h"
#include "msg/bus.h"
#include "sim/simulation.h"

namespace nightjar::scenarios {

/// Setpoints in; truth, vehicle state, frames and events out.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class SimulationNode {
 public:
  SimulationNode(msg::Bus& bus, sim::Simulation& simulation);

  /// Fixes the setpoint to fly next: the last that came.
  void take_setpoint() { flown_ = latest_; }
  /// Flies one packet under it. Touches no bus, so the messages of the packet before
  /// may be handled meanwhile.
  void advance() { step_ = simulation_.advance(flown_); }
  /// Publishes what advance() gave. Truth and vehicle state go first: whoever handles
  /// the picture made of the events has them by then.
  void publish();

  const sim::SimulationStep& step() const { return step_; }

 private:
  msg::Bus& bus_;
  sim::Simulation& simulation_;
  core::AttitudeSetpoint latest_;
  core::AttitudeSetpoint flown_;
  sim::SimulationStep step_;
};

}  // namespace nightjar::scenarios
