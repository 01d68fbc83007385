#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar simulate`: the simulator as a process of its own.
void add_simulate_command(CLI::App& app);

}  // namespace nightjar::tools
