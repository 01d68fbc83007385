#include "scenarios/source_check.h"

namespace nightjar::scenarios {

void check_source(const Scenario& scenario, camera::SourceType wanted) {
  if (scenario.source.type == wanted) return;
  if (wanted == camera::SourceType::simulation)
    throw ScenarioError(
        "source.type = caer, expected simulation: nightjar camera reads a camera, which "
        "nightjar reconstruct --lcm and nightjar track go with (docs/hardware.md)");
  throw ScenarioError(
      "source.type = simulation, expected caer: nightjar simulate flies the simulator");
}

}  // namespace nightjar::scenarios
