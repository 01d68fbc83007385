#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar replay`: a log or a recording as the source of a loop.
void add_replay_command(CLI::App& app);

}  // namespace nightjar::tools
