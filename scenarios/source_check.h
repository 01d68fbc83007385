#pragma once

#include "camera/config.h"
#include "scenarios/scenario.h"

namespace nightjar::scenarios {

/// Throws ScenarioError, with what to start instead, unless the scenario takes its events
/// from `wanted`: no simulator may stand in for a camera unnoticed, nor the reverse.
void check_source(const Scenario& scenario, camera::SourceType wanted);

}  // namespace nightjar::scenarios
