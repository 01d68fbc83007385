#include "scenarios/simulate.h"

#include <optional>

#include "scenarios/flight_end.h"
#include "scenarios/simulation_node.h"
#include "scenarios/source_check.h"
#include "sim/simulation.h"

namespace nightjar::scenarios {

void simulate(const Scenario& scenario, SourceLink& link) {
  check_source(scenario, camera::SourceType::simulation);
  sim::Simulation simulation(scenario.world, scenario.camera, scenario.sensor, scenario.model,
                             scenario.illuminance_lux, static_cast<std::uint64_t>(scenario.seed));
  SimulationNode world(link.inside(), simulation);
  const FlightEnd end(link.inside(), scenario.duration_s);
  world.take_setpoint();
  world.fly();
  while (!end.reached(simulation.world().truth())) {
    const core::Time flown = simulation.world().now();
    // While waiting anyway. In lock-step drawing rather goes on beside the next flight.
    if (!link.lock_step()) simulation.expose_looked();
    const std::optional<core::Time> due = link.wait_until_due(flown);
    world.take_setpoint();
    world.fly();
    world.publish();
    link.exchange(flown, due);
  }
  const core::Time flown = simulation.world().now();
  const std::optional<core::Time> due = link.wait_until_due(flown);
  world.publish();
  link.exchange(flown, due);
}

}  // namespace nightjar::scenarios
