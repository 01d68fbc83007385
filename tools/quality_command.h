#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar quality`, which compares the picture that each method makes of a recording
/// with a reference. Bad input throws std::invalid_argument.
void add_quality_command(CLI::App& app);

}  // namespace nightjar::tools
