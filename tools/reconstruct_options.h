#pragma once

#include <string>
#include <vector>

#include "scenarios/reconstruct_settings.h"

namespace CLI {
class App;
}

namespace nightjar::tools {

/// The options of `reconstruct` and `quality` that say how a method works.
struct MethodOptions {
  std::string config;
  std::vector<std::string> set;
};

void declare(CLI::App& command, MethodOptions& options);

/// Throws std::invalid_argument for a file or a setting that is not allowed.
scenarios::ReconstructSettings settings_of(const MethodOptions& options);

/// The value of --method. Throws std::invalid_argument that lists what is allowed.
esi::Method parse_method(const std::string& name);

}  // namespace nightjar::tools
