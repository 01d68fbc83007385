#include "scenarios/source_check.h"

namespace nightjar::scenarios {

void check_source(const Scenario& scenario, camera::SourceType wanted) {
  if (scenario.source.type == wanted) return;
  if (wanted == camera::SourceType::simulation)
    throw ScenarioError(
        "source.type = caer, expected simulation: no command reads a camera live yet "
        "(docs/hardware.md)");
  throw ScenarioError("source.type = simulation, expected caer: a camera is to be named so");
}

}  // namespace nightjar::scenarios
