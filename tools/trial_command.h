#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// `nightjar trial`: reconstruction methods on simulated sequences whose truth is known.
void add_trial_command(CLI::App& app);

}  // namespace nightjar::tools
