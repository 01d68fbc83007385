#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "tools/bench_command.h"
#include "tools/calibrate_command.h"
#include "tools/camera_command.h"
#include "tools/convert_command.h"
#include "tools/emulate_command.h"
#include "tools/exit_code.h"
#include "tools/info_command.h"
#include "tools/interrupt.h"
#include "tools/parameters_command.h"
#include "tools/quality_command.h"
#include "tools/reconstruct_command.h"
#include "tools/replay_command.h"
#include "tools/run_command.h"
#include "tools/sensor_report_command.h"
#include "tools/simulate_command.h"
#include "tools/track_command.h"
#include "tools/trial_command.h"
#include "tools/view_command.h"

namespace {

using namespace nightjar::tools;

// What OpenCV asks the environment for, see camera::open_frames(); a user's own choice
// stands. Before any thread begins.
void set_up_opencv() {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // our own error says what is wrong
}

int complain(int exit_code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << "nightjar: " << message << '\n';
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  set_up_opencv();
  CLI::App app("Nightjar flies an event camera over a tagged ground vehicle, in the dark.");
  app.set_version_flag("--version", NIGHTJAR_VERSION);
  app.require_subcommand(0, 1);  // none is refused below, after a misspelt one
  int exit_code = kPassed;
  add_run_command(app, exit_code);
  add_bench_command(app);
  add_calibrate_command(app);
  add_camera_command(app);
  add_convert_command(app);
  add_emulate_command(app);
  add_info_command(app);
  add_parameters_command(app);
  add_quality_command(app);
  add_reconstruct_command(app);
  add_replay_command(app);
  add_sensor_report_command(app);
  add_simulate_command(app);
  add_track_command(app);
  add_trial_command(app);
  add_view_command(app);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty())
      return complain(kBadInput, "which subcommand? See nightjar --help");
    return exit_code;
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return complain(kBadInput, error.what());
  } catch (const Interrupted& interrupted) {
    return complain(kInterrupted, interrupted.what());
  } catch (const std::invalid_argument& error) {
    return complain(kBadInput, error.what());
  } catch (const std::exception& error) {
    return complain(kBroken, error.what());
  }
}
