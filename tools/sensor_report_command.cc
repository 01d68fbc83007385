#include "tools/sensor_report_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "camera/event_text.h"
#include "scenarios/gnuplot.h"
#include "scenarios/scenario.h"
#include "scenarios/sensor_report.h"
#include "scenarios/sensor_report_plot.h"
#include "scenarios/sensor_report_text.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::optional<sim::SensorPreset> preset;
  std::optional<double> illuminance_lux;
  std::string scenario;
  std::string recording;
  std::string size;
  std::optional<std::uint64_t> seed;
  double duration_s = scenarios::SensorReportConfig{}.duration_s;
  double speed_px_s = scenarios::SensorReportConfig{}.speed_px_s;
  std::string out;
  bool json = false;
};

constexpr const char* kExamples = R"(
Two scenes are simulated: grey bars at rest, for S seconds, and a texture that moves, for a
fifth of it. Where the figures come from and what they can be compared with: docs/sensor.md.

Examples:
  nightjar sensor-report --preset dim
  nightjar sensor-report --illuminance 300 --recording events.txt --size 346x260 --out report.png
  nightjar sensor-report --scenario scenarios/tracking_landing.yaml --json | jq .columns[0].quiet)";

/// By name; `custom` is for scenario files alone.
std::map<std::string, sim::SensorPreset> presets_by_name() {
  std::map<std::string, sim::SensorPreset> presets;
  for (const auto& [name, preset] : sim::kSensorPresets)
    if (preset != sim::SensorPreset::custom) presets.emplace(name, preset);
  return presets;
}

void declare(CLI::App& command, Arguments& arguments) {
  auto* preset =
      command.add_option("--preset", arguments.preset, "of the pixels; default by_illuminance")
          ->transform(CLI::CheckedTransformer(presets_by_name()))
          ->type_name("P");
  command.add_option("--illuminance", arguments.illuminance_lux, "on a white surface; default 5")
      ->type_name("LUX");
  command
      .add_option("--scenario", arguments.scenario,
                  "take sensor, illuminance, size and seed from a scenario file")
      ->excludes(preset)
      ->type_name("FILE");
  command.add_option("--recording", arguments.recording, "events of a real sensor: t x y polarity")
      ->type_name("FILE");
  command
      .add_option("--size", arguments.size,
                  "of the sensor, both simulated and recorded; default 346x260 and what the "
                  "recording's events need")
      ->type_name("WxH");
  command.add_option("--seed", arguments.seed, "of all randomness; default 1")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  command.add_option("--duration", arguments.duration_s, "of the scene at rest")
      ->capture_default_str()
      ->type_name("S");
  command.add_option("--speed", arguments.speed_px_s, "of the moving texture")
      ->capture_default_str()
      ->type_name("PX_S");
  command.add_option("--out", arguments.out, "draw the report here; needs gnuplot")
      ->type_name("FILE.png");
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.footer(kExamples);
}

std::optional<core::Resolution> parse_size(const std::string& text) {
  if (text.empty()) return std::nullopt;
  core::Resolution size;
  int length = 0;
  // "%4d": no number that would not fit
  const int read = std::sscanf(text.c_str(), "%4dx%4d%n", &size.width_px, &size.height_px, &length);
  if (read != 2 || static_cast<std::size_t>(length) != text.size() || size.width_px < 1 ||
      size.height_px < 1)
    throw std::invalid_argument(fmt::format("--size = {}, expected as in 346x260", text));
  return size;
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
  config.sensor.preset = arguments.preset.value_or(config.sensor.preset);
  config.illuminance_lux = arguments.illuminance_lux.value_or(config.illuminance_lux);
  config.size = parse_size(arguments.size).value_or(config.size);
  config.seed = arguments.seed.value_or(config.seed);
  config.duration_s = arguments.duration_s;
  config.speed_px_s = arguments.speed_px_s;
  return config;
}

/// Fails before the work, not after it.
void check_output(const std::string& out) {
  if (out.empty()) return;
  const fs::path folder = fs::absolute(out).parent_path();
  if (fs::path(out).extension() != ".png" || !fs::is_directory(folder) || fs::is_directory(out))
    throw std::invalid_argument(
        fmt::format("--out = {}, expected a .png file in a folder that exists", out));
  scenarios::run_gnuplot("");
}

void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream) throw std::invalid_argument(fmt::format("{}: cannot be written", path));
}

void run(const Arguments& arguments) {
  const scenarios::SensorReportConfig config = config_of(arguments);
  check_output(arguments.out);
  std::optional<scenarios::ReportColumn> recorded;
  if (!arguments.recording.empty())
    recorded = scenarios::report_on_recording(
        fs::path(arguments.recording).filename().string(),
        camera::read_event_text(arguments.recording, parse_size(arguments.size)));

  std::optional<ProgressBar> progress;
  if (isatty(STDERR_FILENO) != 0) progress.emplace(std::cerr, true);
  note_interrupts();
  scenarios::SensorReport report = scenarios::report_on_sensor(
      config, [&](double done_s, double end_s, const std::string& phase) {
        throw_if_interrupted();
        if (progress) progress->update(done_s, end_s, phase);
      });
  progress.reset();
  if (recorded) report.columns.push_back(std::move(*recorded));

  if (!arguments.out.empty()) write_file(arguments.out, draw_png(report));
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
