#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/scenario.h"
#include "scenarios/summary.h"

namespace nightjar::scenarios {

struct RunOptions {
  std::filesystem::path out;   ///< Folder of the results; see OutputFolder.
  bool video = true;           ///< Make run.mp4.
  bool record_events = false;  ///< Add the raw events to run.lcm.
  /// Called once a packet with the simulated time, the longest the run may last and
  /// the mission's phase. What it throws ends the run.
  std::function<void(double sim_time_s, double end_s, const std::string& phase)> on_progress;
};

/// Flies the scenario in lock-step and leaves its results in options.out, which is
/// cleared of an earlier run's before anything else.
///
/// The picture of packet k is searched for the tag once the world has been flown to the
/// end of packet k + 1; the setpoint that follows from it is flown from packet k + 2 on.
/// So a real computer's latency, one packet, is part of the run, and the order of all
/// messages is the same in every run. All this is one thread's work; another one draws
/// (docs/decisions/0003).
///
/// The run ends half a second after touchdown, with a crash, or at
/// scenario.duration_s. Throws std::invalid_argument (ScenarioError) for bad input,
/// std::runtime_error for a disk or a renderer that fails.
Summary run(const Scenario& scenario, const RunOptions& options);

}  // namespace nightjar::scenarios
