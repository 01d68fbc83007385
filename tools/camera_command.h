#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar camera`: a DAVIS346 as a process.
void add_camera_command(CLI::App& app);

}  // namespace nightjar::tools
