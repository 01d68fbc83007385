#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar track`: the companion computer's tracker as a process of its own.
void add_track_command(CLI::App& app);

}  // namespace nightjar::tools
