#pragma once

#include "scenarios/scenario.h"
#include "scenarios/source_link.h"

namespace nightjar::scenarios {

/// Flies the scenario as the source of a loop whose other nodes are other processes. In
/// lock-step setpoints act as in run(): on the same packets, with the same bits.
///
/// Ends as run() does. Throws std::invalid_argument (ScenarioError) for bad input,
/// std::runtime_error for a renderer that fails, and what the link throws.
void simulate(const Scenario& scenario, SourceLink& link);

}  // namespace nightjar::scenarios
