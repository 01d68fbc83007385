#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar run`, which flies one scenario while the command line is
/// parsed. Its exit code goes to `exit_code`, which has to outlive `app`; bad
/// input throws std::invalid_argument, Ctrl-C Interrupted.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace nightjar::tools
