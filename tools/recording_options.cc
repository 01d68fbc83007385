#include "tools/recording_options.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "scenarios/recordings.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {

void declare(CLI::App& command, RecordingOptions& options, const std::string& name) {
  command
      .add_option(name, options.path,
                  "a recording: AEDAT4, AEDAT 3.1, AEDAT 2.0 (DAVIS), text or an LCM log of ours, "
                  "told by its content")
      ->required();
  command
      .add_option("--size", options.size,
                  "of the sensor, where the file does not tell it; for text the least that holds "
                  "its events otherwise")
      ->type_name("WxH");
  command.add_flag("--quiet", options.quiet, "no progress, no table");
}

std::unique_ptr<camera::RecordingReader> open(const RecordingOptions& options) {
  std::optional<core::Resolution> size;
  if (options.size) size = parse_size(*options.size);
  auto recording = scenarios::open_recording(options.path, size);
  note_interrupts();  // before there is anything to leave behind
  return recording;
}

std::function<void(double)> progress_of(const RecordingOptions& options, const std::string& phase) {
  std::shared_ptr<ProgressBar> bar;
  if (!options.quiet && isatty(STDERR_FILENO) != 0)
    bar = std::make_shared<ProgressBar>(std::cerr, true);
  return [bar, phase](double share) {
    throw_if_interrupted();
    if (bar) bar->update(share, phase);
  };
}

void warn(const std::string& text) {
  if (!text.empty()) std::cerr << "nightjar: warning: " << text << '\n';
}

}  // namespace nightjar::tools
