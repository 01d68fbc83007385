#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar info`, which reads a recording through and says what is in it while the
/// command line is parsed. Bad input throws std::invalid_argument, Ctrl-C Interrupted.
void add_info_command(CLI::App& app);

}  // namespace nightjar::tools
