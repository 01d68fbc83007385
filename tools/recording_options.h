#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
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

/// What `work` gives; an Error, which knows no file, is thrown on with the name of this one.
template <class Error = std::invalid_argument, class Work>
auto naming(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw std::invalid_argument(file + ": " + error.what());
  }
}

/// One line on stderr; nothing for an empty `text`.
void warn(const std::string& text);

}  // namespace nightjar::tools
