#include "tools/bench_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/recording.h"
#include "core/part_file.h"
#include "esi/make_reconstructor.h"
#include "scenarios/event_workloads.h"
#include "scenarios/gnuplot.h"
#include "scenarios/reconstruction_speed.h"
#include "scenarios/reconstruction_speed_text.h"
#include "scenarios/recordings.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/reconstruct_options.h"
#include "tools/recording_options.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string recording;
  std::optional<std::string> size;
  std::vector<std::string> methods;
  MethodOptions options;
  std::string plot;
  bool json = false;
  bool quiet = false;
};

/// So many that they do not stay in any cache.
constexpr std::size_t kEvents = 12'000'000;
/// Of the made-up workloads, the one whose pictures are timed: moving edges, 5 Mev/s.
constexpr std::size_t kPlotted = 4;

constexpr const char* kNotes = R"(
Million events a second of CPU time on one thread, medians of three rounds in turn; events
come in packets of 10 ms, without pictures and with one after every packet. `reference` is
ESI in doubles and std::pow; `bound` reads each 8-byte event and touches its pixel's 8-byte
cell, which no method can do without. Ratios are good to a few per cent, and hold from one
machine to another better than rates do.

Without RECORDING: uniform and moving-edge events of a 346x260 sensor at nominal 1, 5 and 12
million events a second, with a frame every 40 ms. Of a recording the first 12 million
events are taken. Networks are measured where --method names them, with --weights.

Examples:
  nightjar bench
  nightjar bench flight.aedat4 --method esi --set reconstructor.esi.decay_power=2.5
  nightjar bench --method esi --method accumulator --plot times.png --json

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, or no gnuplot, 130 interrupted.)";

void declare(CLI::App& command, Arguments& arguments) {
  command.add_option("RECORDING", arguments.recording, "as `nightjar reconstruct` takes it");
  command.add_option("--size", arguments.size, "of the sensor, where the recording does not tell")
      ->type_name("WxH");
  command
      .add_option("--method", arguments.methods,
                  "one method; may be repeated; default all but the networks")
      ->take_all()
      ->type_name("NAME");
  declare(command, arguments.options);
  command
      .add_option("--plot", arguments.plot,
                  "draw time per picture against pictures a second, 50 to 2000; needs gnuplot")
      ->type_name("FILE.png");
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.add_flag("--quiet", arguments.quiet, "no progress");
  command.footer(kNotes);
}

scenarios::SpeedOptions options_of(const Arguments& arguments) {
  scenarios::SpeedOptions options;
  options.reconstructor = settings_of(arguments.options).reconstructor;
  for (const std::string& name : arguments.methods) options.methods.push_back(parse_method(name));
  if (options.methods.empty())
    for (const auto& [name, method] : esi::kMethods)
      if (!esi::is_network(method)) options.methods.push_back(method);
  return options;
}

std::optional<scenarios::EventWorkload> recorded(const Arguments& arguments) {
  if (arguments.recording.empty()) {
    if (arguments.size) throw std::invalid_argument("--size only matters with a recording");
    return std::nullopt;
  }
  std::optional<core::Resolution> size;
  if (arguments.size) size = parse_size(*arguments.size);
  const auto reader = scenarios::open_recording(arguments.recording, size);
  auto workload =
      scenarios::read_workload(*reader, fs::path(arguments.recording).filename().string(), kEvents);
  warn(reader->faults().first);
  return workload;
}

/// Fails before the work, not after it.
std::unique_ptr<core::PartFile> open_picture(const std::string& out) {
  if (out.empty()) return nullptr;
  if (fs::path(out).extension() != ".png")
    throw std::invalid_argument(fmt::format("--plot = {}, allowed a name ending in .png", out));
  scenarios::run_gnuplot("");
  return std::make_unique<core::PartFile>(out);
}

/// What has been measured, and the progress through it.
class Bench {
 public:
  Bench(scenarios::SpeedOptions options, bool quiet) : options_(std::move(options)) {
    if (!quiet && isatty(STDERR_FILENO) != 0) bar_.emplace(std::cerr, true);
  }

  void measure(const scenarios::EventWorkload& workload, std::size_t index, std::size_t count) {
    track(workload.name, index, count);
    speeds.push_back(measure_speed(workload, options_));
  }

  void measure_pictures(const scenarios::EventWorkload& workload) {
    track("time per picture", 0, 1);
    times = measure_picture_times(workload, options_);
  }

  void end_progress() { bar_.reset(); }

  std::vector<scenarios::WorkloadSpeed> speeds;
  std::vector<scenarios::MethodPictureTimes> times;

 private:
  void track(const std::string& phase, std::size_t index, std::size_t count) {
    options_.on_progress = [this, phase, index, count](double share) {
      throw_if_interrupted();
      if (bar_)
        bar_->update((static_cast<double>(index) + share) / static_cast<double>(count), phase);
    };
  }

  scenarios::SpeedOptions options_;
  std::optional<ProgressBar> bar_;
};

void run(const Arguments& arguments) {
  const scenarios::SpeedOptions options = options_of(arguments);
  const std::optional<scenarios::EventWorkload> recording = recorded(arguments);
  note_interrupts();  // before there is anything to leave behind
  const std::unique_ptr<core::PartFile> picture = open_picture(arguments.plot);
  Bench bench(options, arguments.quiet);
  if (recording)
    bench.measure(*recording, 0, 1);
  else
    for (std::size_t i = 0; i < scenarios::kWorkloads; ++i)
      bench.measure(scenarios::make_workload(i, kEvents), i, scenarios::kWorkloads);
  if (picture) {
    const auto workload = recording ? *recording : scenarios::make_workload(kPlotted, kEvents);
    bench.measure_pictures(workload);
    picture->stream() << draw_picture_times(workload.name, bench.times);
    picture->finish();
  }
  bench.end_progress();
  if (arguments.json) {
    std::cout << to_json(bench.speeds, bench.times);
    return;
  }
  std::cout << to_table(bench.speeds);
  if (picture) std::cout << to_table(bench.times);
}

}  // namespace

void add_bench_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bench", "how fast the reconstruction methods are");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
