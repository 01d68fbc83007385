#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar reconstruct`, which turns a recording into pictures and looks for tags in
/// them while the command line is parsed. Bad input throws std::invalid_argument, Ctrl-C
/// Interrupted; neither leaves a file.
void add_reconstruct_command(CLI::App& app);

}  // namespace nightjar::tools
