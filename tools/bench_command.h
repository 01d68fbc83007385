#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar bench`, which measures how fast the reconstruction methods are. Bad
/// input throws std::invalid_argument, Ctrl-C Interrupted, a missing gnuplot
/// std::runtime_error.
void add_bench_command(CLI::App& app);

}  // namespace nightjar::tools
