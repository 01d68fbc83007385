#include "scenarios/simulate.h"

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
  const auto handle = [&](core::Time t) {
    world.publish();
    link.exchange(t);
  };
  world.take_setpoint();
  world.fly();
  while (!end.reached(simulation.world().truth())) {
    const core::Time flown = simulation.world().now();
    link.wait_until_due(flown);
    world.take_setpoint();
    world.fly();
    handle(flown);
  }
  link.wait_until_due(simulation.world().now());
  handle(simulation.world().now());
}

}  // namespace nightjar::scenarios
