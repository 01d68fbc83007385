#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "camera/recording.h"

namespace CLI {
class App;
}

namespace nightjar::tools {

/// What every subcommand that reads a recording asks for.
struct RecordingOptions {
  std::string path;
  std::optional<std::string> size;
  bool quiet = false;
};

/// Declares FILE (under `name`), --size and --quiet.
void declare(CLI::App& command, RecordingOptions& options, const std::string& name);

/// Opens it; from then on Ctrl-C is noted.
std::unique_ptr<camera::RecordingReader> open(const RecordingOptions& options);

/// To be called with the share that is done: throws Interrupted after Ctrl-C and draws a
/// progress bar on a terminal. The bar goes away with the function.
std::function<void(double)> progress_of(const RecordingOptions& options, const std::string& phase);

/// One line on stderr; nothing for an empty `text`.
void warn(const std::string& text);

}  // namespace nightjar::tools
