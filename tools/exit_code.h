#pragma once

namespace nightjar::tools {

/// What the program answers to the shell.
enum ExitCode : int {
  kPassed = 0,
  kFailed = 1,
  kBadInput = 2,
  kBroken = 3,  ///< our own mistake, or a full disk
  kInterrupted = 130,
};

}  // namespace nightjar::tools
