#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar parameters`, which lists what a scenario file may say.
void add_parameters_command(CLI::App& app);

}  // namespace nightjar::tools
