#include "tools/emulate_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "camera/frame_source.h"
#include "camera/recording_writer.h"
#include "scenarios/emulate.h"
#include "scenarios/recordings.h"
#include "scenarios/scenario.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path input;
  std::filesystem::path out;
  std::optional<double> fps;
  std::optional<std::string> preset;
  std::optional<std::filesystem::path> scenario;
  std::optional<double> illuminance_lux;
  std::optional<std::string> size;
  double white = 1.0;
  std::optional<int> seed;
  bool json = false;
  bool quiet = false;
};

constexpr const char* kDefaultPreset = "dim";

constexpr const char* kNotes = R"(
Frames: 8- and 16-bit codes are taken as linear intensity (as v2e does), white is 255
or 65535; colours are weighed by BT.709. Between two frames each pixel's log intensity is
linear in time, no frames are made up: give so many that little moves more than a pixel
from one to the next. The sensor has the size of the frames (or --size, 346x260 for a
DAVIS346), frames are not undistorted or cropped.

EVENTS is an AEDAT recording, or a text with one event a line, "t_seconds x y polarity",
polarity 1 = ON, 0 = OFF; the first frame is at 0. It appears when it is complete. Events that wait for the readout at
the last frame come at its end, with times after that frame.

Examples:
  nightjar emulate frames/ --fps 500 --preset dim --out events.txt
  nightjar emulate tennis.mp4 --size 346x260 --preset clean --out events.aedat4
  nightjar emulate slow.mp4 --fps 960 --out events.txt     (played at 30, taken at 960 Hz)
  nightjar emulate frames/ --fps 100 --preset by_illuminance --illuminance 50 --out e.txt
  nightjar emulate exr/ --fps 1000 --white 4 --scenario scenarios/smoke.yaml --out e.txt

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, 130 interrupted.)";

void declare(CLI::App& command, Arguments& arguments) {
  command
      .add_option("INPUT", arguments.input,
                  "a folder of pictures (PNG, TIFF, PGM, JPEG, EXR, HDR, PFM, ...), taken in the "
                  "order of their names (frame2 before frame10), or a video")
      ->required();
  command
      .add_option("--out", arguments.out,
                  "where the events go: a name ending in .txt, .aedat4, .aedat (3.1) or .lcm")
      ->required()
      ->type_name("EVENTS");
  command
      .add_option(
          "--fps", arguments.fps,
          "frames per second when they were taken; needed for pictures, a video has its own")
      ->type_name("N");
  CLI::Option* preset = command
                            .add_option("--preset", arguments.preset,
                                        "how the pixels behave: clean, bright, dim (default) or "
                                        "by_illuminance")
                            ->type_name("NAME");
  command
      .add_option("--scenario", arguments.scenario,
                  "take the sensor, illuminance and seed of a scenario file instead")
      ->excludes(preset)
      ->type_name("FILE");
  command
      .add_option("--illuminance", arguments.illuminance_lux,
                  "for by_illuminance: the scene's light")
      ->type_name("LUX");
  command.add_option("--size", arguments.size, "resize the frames, averaging over the area")
      ->type_name("WxH");
  command.add_option("--white", arguments.white, "what is white in pictures of floats")
      ->capture_default_str()
      ->type_name("VALUE");
  command.add_option("--seed", arguments.seed, "of all randomness, 1 by default")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  command.add_flag("--json", arguments.json, "print the summary as JSON");
  command.add_flag("--quiet", arguments.quiet, "no progress, no table");
  command.footer(kNotes);
}

/// A value that would change nothing is refused, and so is one that is missing.
void set_illuminance(const Arguments& arguments, scenarios::EmulateOptions& options) {
  const bool asked_for = options.sensor.preset == sim::SensorPreset::by_illuminance;
  if (!arguments.illuminance_lux) {
    if (asked_for && !arguments.scenario)
      throw std::invalid_argument("--preset by_illuminance needs --illuminance");
    return;
  }
  if (!asked_for)
    throw std::invalid_argument("--illuminance only matters with the preset by_illuminance");
  core::check_range("--illuminance", *arguments.illuminance_lux, 0.1, 100000);  // as a scenario's
  options.illuminance_lux = *arguments.illuminance_lux;
}

scenarios::EmulateOptions options_of(const Arguments& arguments) {
  scenarios::EmulateOptions options;
  if (arguments.scenario) {
    const scenarios::Scenario scenario = scenarios::load(*arguments.scenario);
    options.sensor = scenario.sensor;
    options.illuminance_lux = scenario.illuminance_lux;
    options.seed = static_cast<std::uint64_t>(scenario.seed);
  } else {
    options.sensor.preset = parse_preset(arguments.preset.value_or(kDefaultPreset));
  }
  set_illuminance(arguments, options);
  if (arguments.seed) options.seed = static_cast<std::uint64_t>(*arguments.seed);
  return options;
}

camera::FrameOptions frame_options_of(const Arguments& arguments) {
  camera::FrameOptions options;
  options.rate_hz = arguments.fps;
  if (arguments.size) options.size = parse_size(*arguments.size);
  options.float_white = arguments.white;
  return options;
}

scenarios::Emulation emulate(const Arguments& arguments) {
  scenarios::check_recording_name("--out", arguments.out);
  scenarios::EmulateOptions options = options_of(arguments);
  const auto frames = camera::open_frames(arguments.input, frame_options_of(arguments));
  note_interrupts();  // before there is anything to leave behind
  std::unique_ptr<camera::RecordingWriter> out;
  camera::RecordingPart part;

  std::optional<ProgressBar> progress;
  if (!arguments.quiet && isatty(STDERR_FILENO) != 0) progress.emplace(std::cerr, true);
  options.on_start = [&](core::Resolution size) {
    out = scenarios::create_recording(arguments.out, {size, "Nightjar"});
  };
  options.on_progress = [&](double done_s, double end_s) {
    throw_if_interrupted();
    if (progress && end_s > 0) progress->update(done_s, end_s, "emulating");
  };
  const scenarios::Emulation emulation = scenarios::emulate(*frames, options, [&](auto events) {
    part.events.assign(events.begin(), events.end());
    out->write(part);
  });
  out->finish();
  return emulation;
}

void run(const Arguments& arguments) {
  const scenarios::Emulation emulation = emulate(arguments);
  if (const std::string warning = scenarios::warning(emulation); !warning.empty())
    std::cerr << "nightjar: warning: " << warning << '\n';
  if (arguments.json)
    std::cout << to_json(emulation);
  else if (!arguments.quiet)
    std::cout << to_table(emulation);
}

}  // namespace

void add_emulate_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("emulate", "turn pictures or a video into events");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
