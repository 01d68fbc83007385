#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar calibrate`, which finds a camera's intrinsics while the command line is
/// parsed. Bad input, too few views among it, throws std::invalid_argument, Ctrl-C Interrupted;
/// neither leaves a file.
void add_calibrate_command(CLI::App& app);

}  // namespace nightjar::tools
