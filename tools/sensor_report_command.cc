#include "tools/sensor_report_command.h"

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

#include "camera/event_text.h"
#include "camera/recording.h"
#include "core/part_file.h"
#include "scenarios/gnuplot.h"
#include "scenarios/recordings.h"
#include "scenarios/scenario.h"
#include "scenarios/sensor_report.h"
#include "scenarios/sensor_report_plot.h"
#include "scenarios/sensor_report_text.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::optional<std::string> preset;
  std::optional<double> illuminance_lux;
  std::string scenario;
  std::string recording;
  std::optional<std::string> size;
  std::optional<std::uint64_t> seed;
  double duration_s = scenarios::SensorReportConfig{}.duration_s;
  double speed_px_s = scenarios::SensorReportConfig{}.speed_px_s;
  std::string out;
  bool json = false;
};

constexpr const char* kExamples = R"(
Two scenes are simulated: grey bars at rest, for S seconds, and a texture that moves, for a
fifth of it, or for its first two pictures where they take longer. Where the figures come
from and what they can be compared with: docs/sensor.md.

Examples:
  nightjar sensor-report --preset dim
  nightjar sensor-report --illuminance 300 --recording road.aedat4 --out report.png
  nightjar sensor-report --scenario scenarios/tracking_landing.yaml --json | jq .columns[0].quiet

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, or no gnuplot, 130 interrupted.)";

void declare(CLI::App& command, Arguments& arguments) {
  auto* preset =
      command
          .add_option("--preset", arguments.preset,
                      "how the pixels behave: " + preset_names() + "; default by_illuminance")
          ->type_name("NAME");
  command.add_option("--illuminance", arguments.illuminance_lux, "on a white surface; default 5")
      ->type_name("LUX");
  command
      .add_option("--scenario", arguments.scenario,
                  "take sensor, illuminance, size and seed from a scenario file")
      ->excludes(preset)
      ->type_name("FILE");
  command
      .add_option("--recording", arguments.recording,
                  "events of a real sensor: AEDAT4, AEDAT 3.1, AEDAT 2.0, text or an LCM log of ours")
      ->type_name("FILE");
  command
      .add_option("--size", arguments.size,
                  "of the sensor, both simulated and recorded; default 346x260 and what the "
                  "recording's events need")
      ->type_name("WxH");
  command.add_option("--seed", arguments.seed, "of all randomness; default 1")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  command.add_option("--duration", arguments.duration_s, "of the scene at rest, 0.1 to 60")
      ->capture_default_str()
      ->type_name("S");
  command.add_option("--speed", arguments.speed_px_s, "of the moving texture, 10 to 2000")
      ->capture_default_str()
      ->type_name("PX_S");
  command.add_option("--out", arguments.out, "draw the report here; needs gnuplot")
      ->type_name("FILE.png");
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.footer(kExamples);
}

/// A recording of any format, at once. Text is taken strictly; what else is not as it
/// should be is warned of.
camera::EventRecording read_recording(const fs::path& path, std::optional<core::Resolution> size) {
  const auto reader = scenarios::open_recording(path, size);
  if (reader->format() == "text") return camera::read_event_text(path, size);
  camera::EventRecording recording{reader->size(), {}};
  for (camera::RecordingPart part; reader->next(part);)
    recording.events.insert(recording.events.end(), part.events.begin(), part.events.end());
  if (reader->faults().any()) std::cerr << "nightjar: warning: " << reader->faults().first << '\n';
  return recording;
}

scenarios::SensorReportConfig config_of(const Arguments& arguments) {
  scenarios::SensorReportConfig config;
  if (!arguments.scenario.empty()) {
    const scenarios::Scenario scenario = scenarios::load(arguments.scenario);
    config.sensor = scenario.sensor;
    config.illuminance_lux = scenario.illuminance_lux;
    config.size = {scenario.camera.width_px, scenario.camera.height_px};
    config.seed = static_cast<std::uint64_t>(scenario.seed);
  }
  if (arguments.preset) config.sensor.preset = parse_preset(*arguments.preset);
  config.illuminance_lux = arguments.illuminance_lux.value_or(config.illuminance_lux);
  if (arguments.size) config.size = parse_size(*arguments.size);
  config.seed = arguments.seed.value_or(config.seed);
  config.duration_s = arguments.duration_s;
  config.speed_px_s = arguments.speed_px_s;
  return config;
}

std::optional<core::Resolution> recorded_size(const Arguments& arguments) {
  if (!arguments.size) return std::nullopt;
  return parse_size(*arguments.size);
}

/// Fails before the work, not after it.
std::unique_ptr<core::PartFile> open_picture(const std::string& out) {
  if (out.empty()) return nullptr;
  if (fs::path(out).extension() != ".png")
    throw std::invalid_argument(fmt::format("--out = {}, allowed a name ending in .png", out));
  scenarios::run_gnuplot("");
  return std::make_unique<core::PartFile>(out);
}

void run(const Arguments& arguments) {
  const scenarios::SensorReportConfig config = config_of(arguments);
  std::optional<scenarios::ReportColumn> recorded;
  if (!arguments.recording.empty())
    recorded = scenarios::report_on_recording(
        fs::path(arguments.recording).filename().string(),
        read_recording(arguments.recording, recorded_size(arguments)));

  note_interrupts();  // before there is anything to leave behind
  const std::unique_ptr<core::PartFile> picture = open_picture(arguments.out);
  std::optional<ProgressBar> progress;
  if (isatty(STDERR_FILENO) != 0) progress.emplace(std::cerr, true);
  scenarios::SensorReport report = scenarios::report_on_sensor(
      config, [&](double done_s, double end_s, const std::string& phase) {
        throw_if_interrupted();
        if (progress) progress->update(done_s, end_s, phase);
      });
  progress.reset();
  if (recorded) report.columns.push_back(std::move(*recorded));

  if (picture) {
    picture->stream() << draw_png(report);
    picture->finish();
  }
  std::cout << (arguments.json ? to_json(report) : to_table(report));
}

}  // namespace

void add_sensor_report_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "sensor-report", "how the event sensor behaves: noise, polarity, hot pixels, intervals");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
