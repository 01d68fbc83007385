#pragma once

#include <optional>
#include <string>

#include "core/event.h"
#include "esi/config.h"
#include "scenarios/node_process.h"
#include "scenarios/scenario.h"

namespace nightjar::scenarios {

/// Events and frames in, pictures out, each run with a reconstructor of its own.
NodeProcess::Setup reconstruction_process(const esi::ReconstructorConfig& config,
                                          core::Resolution size);

/// Pictures and vehicle states in, setpoints out. `estimates_sha256` (EstimatesHash) is of
/// the latest run's estimates so far; it must outlive the process. The camera is
/// camera_model()'s; where it sits on the UAV is told by source.mount for a real one, and by
/// the scenario's model, to the bit, for the simulator's: then throws as sim::World does.
NodeProcess::Setup tracker_process(const Scenario& scenario, std::string& estimates_sha256);

}  // namespace nightjar::scenarios
