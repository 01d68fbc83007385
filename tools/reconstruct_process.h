#pragma once

#include <string>

#include "tools/process_options.h"

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar reconstruct --lcm`: the reconstruction as a process of its own.
struct ReconstructProcess {
  bool wanted = false;  ///< --lcm was given.
  ProcessOptions options;

  /// Adds --lcm and --lcm-url to the command, whose other options all but RECORDING, --json
  /// and --quiet go with recordings alone; to be called after those are added.
  void declare(CLI::App& command);

  /// Serves until SIGINT or SIGTERM, with the scenario's reconstructor and sensor size.
  void run(const std::string& scenario) const;
};

}  // namespace nightjar::tools
