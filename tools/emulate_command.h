#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar emulate`, which turns pictures or a video into events while the
/// command line is parsed. Bad input throws std::invalid_argument, Ctrl-C Interrupted;
/// neither leaves a file.
void add_emulate_command(CLI::App& app);

}  // namespace nightjar::tools
