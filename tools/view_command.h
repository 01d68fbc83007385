#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar view`, which draws a moment of a recording while the command line is
/// parsed. Bad input throws std::invalid_argument, Ctrl-C Interrupted; neither leaves a file.
void add_view_command(CLI::App& app);

}  // namespace nightjar::tools
