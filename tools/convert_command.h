#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar convert`, which writes a recording in another format while the command
/// line is parsed. Bad input throws std::invalid_argument, Ctrl-C Interrupted; neither leaves
/// a file.
void add_convert_command(CLI::App& app);

}  // namespace nightjar::tools
