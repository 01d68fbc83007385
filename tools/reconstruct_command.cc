#include "tools/reconstruct_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "camera/recording.h"
#include "esi/quality.h"
#include "scenarios/gray_picture.h"
#include "scenarios/reconstruct.h"
#include "scenarios/reconstruction_folder.h"
#include "scenarios/recordings.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/reconstruct_options.h"
#include "tools/reconstruct_process.h"
#include "tools/recording_options.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

constexpr const char* kTagFamily = "36h11";

struct Arguments {
  std::string recording;
  std::string method;  ///< Empty: as the config file says.
  double fps = 100;
  std::string weights;
  std::optional<std::string> size;
  std::string out;
  bool video = false;
  std::string tags;
  std::optional<double> from_s, until_s;
  std::string reference;
  MethodOptions options;
  bool list_methods = false;
  ReconstructProcess process;
  bool json = false;
  bool quiet = false;
};

constexpr const char* kNotes = R"(
Recordings: AEDAT4, AEDAT 3.1, AEDAT 2.0, LCM logs of ours (nightjar run --record-events), or
text, "t_seconds x y polarity" a line; the content tells which. The first picture is due 1/N s after the first event, the last no later
than the last event. Methods that use the frames of the active pixels get the recording's.

DIR: picture_000001.png, ... (or pictures.mp4, which plays in real time), times.csv
(picture,time_us: the recording's own time), tags.csv
(time_us,id,hamming,decision_margin,corners_px: x and y of four corners with blanks between,
pixel centres at whole numbers) and, at the end, summary.json. An earlier result in DIR is
replaced. Nothing is left of a run that did not end well.

Examples:
  nightjar reconstruct flight.aedat4 --method esi --fps 100 --out pictures --tags 36h11
  nightjar reconstruct events.txt --size 240x180 --video --out film
  nightjar reconstruct flight.aedat4 --method firenet --weights firenet.onnx --out pictures
  nightjar reconstruct flight.aedat4 --set reconstructor.esi.decay_rate_hz=4 --tags 36h11 --json
  nightjar reconstruct --lcm scenarios/smoke.yaml   # see nightjar simulate --help

Exit codes: 0 done (--lcm: stopped by SIGINT or SIGTERM), 2 bad input, 3 our own fault or the disk's, 130 interrupted.)";

void declare_output(CLI::App& command, Arguments& arguments) {
  command.add_option("--out", arguments.out, "the folder of the pictures; none: only count")
      ->type_name("DIR");
  command.add_flag("--video", arguments.video, "one video instead of a PNG for each picture");
  command.add_option("--tags", arguments.tags, "look for AprilTags of this family: 36h11")
      ->type_name("FAMILY");
  command
      .add_option("--score", arguments.reference,
                  "compare the picture at the end with this one: MSE, PSNR and SSIM after "
                  "fitting the grey levels")
      ->type_name("PICTURE");
  command.add_flag("--json", arguments.json, "print the summary as JSON");
  command.add_flag("--quiet", arguments.quiet, "no progress, no table");
}

void declare(CLI::App& command, Arguments& arguments) {
  command.add_option("RECORDING", arguments.recording, "the events, see below");
  command.add_flag("--list-methods", arguments.list_methods, "name the methods, one a line");
  command.add_option("--method", arguments.method, "esi by default; see --list-methods")
      ->type_name("NAME");
  command.add_option("--fps", arguments.fps, "pictures a second, 0.01 to 100000")
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--size", arguments.size,
                  "of the sensor, for recordings that do not tell it: text, AEDAT 2.0")
      ->type_name("WxH");
  command.add_option("--weights", arguments.weights, "of a network, an ONNX file")
      ->type_name("FILE.onnx");
  declare(command, arguments.options);
  command.add_option("--from", arguments.from_s, "begin this long after the first event")
      ->type_name("S");
  command.add_option("--until", arguments.until_s, "end this long after the first event")
      ->type_name("S");
  declare_output(command, arguments);
  command.footer(kNotes);
}

void check(const Arguments& arguments) {
  if (arguments.recording.empty())
    throw std::invalid_argument("which RECORDING? See nightjar reconstruct --help");
  if (!arguments.tags.empty() && arguments.tags != kTagFamily)
    throw std::invalid_argument(fmt::format("--tags = {}, allowed {}", arguments.tags, kTagFamily));
  if (arguments.video && arguments.out.empty()) throw std::invalid_argument("--video needs --out");
}

void set_weights(const std::string& weights, esi::ReconstructorConfig& config) {
  switch (config.method) {
    case esi::Method::firenet: config.firenet.weights = weights; return;
    case esi::Method::e2vid: config.e2vid.weights = weights; return;
    default: throw std::invalid_argument("--weights only matters with --method firenet or e2vid");
  }
}

scenarios::ReconstructOptions options_of(const Arguments& arguments) {
  const scenarios::ReconstructSettings settings = settings_of(arguments.options);
  scenarios::ReconstructOptions options;
  options.reconstructor = settings.reconstructor;
  if (!arguments.method.empty()) options.reconstructor.method = parse_method(arguments.method);
  if (!arguments.weights.empty()) set_weights(arguments.weights, options.reconstructor);
  options.rate_hz = arguments.fps;
  if (!arguments.tags.empty()) options.detector = settings.tracker.detector;
  options.from_s = arguments.from_s;
  options.until_s = arguments.until_s;
  return options;
}

/// What the run leaves: its summary, and files where they are asked for.
struct Result {
  scenarios::Reconstruction reconstruction;
  std::optional<esi::Quality> quality;

  std::string json() const {
    auto json = nlohmann::ordered_json::parse(to_json(reconstruction));
    if (quality)
      json["score"] = {
          {"mse", quality->mse}, {"psnr_db", quality->psnr_db}, {"ssim", quality->ssim}};
    return json.dump(2) + '\n';
  }

  std::string table() const {
    std::string table = to_table(reconstruction);
    if (quality)
      table += fmt::format("  {:<12}MSE {:.1f}, PSNR {:.2f} dB, SSIM {:.4f}\n", "score",
                           quality->mse, quality->psnr_db, quality->ssim);
    return table;
  }
};

Result reconstruct(const Arguments& arguments) {
  scenarios::ReconstructOptions options = options_of(arguments);
  std::optional<core::Resolution> size;
  if (arguments.size) size = parse_size(*arguments.size);
  const auto recording = scenarios::open_recording(arguments.recording, size);
  std::optional<core::Image<std::uint8_t>> reference;
  if (!arguments.reference.empty()) reference = scenarios::read_gray_picture(arguments.reference);

  note_interrupts();  // before there is anything to leave behind
  std::optional<scenarios::ReconstructionFolder> folder;
  if (!arguments.out.empty())
    folder.emplace(arguments.out,
                   scenarios::ReconstructionFolder::Options{.video = arguments.video,
                                                            .tags = options.detector.has_value(),
                                                            .size = recording->size(),
                                                            .rate_hz = options.rate_hz});
  std::optional<ProgressBar> progress;
  if (!arguments.quiet && isatty(STDERR_FILENO) != 0) progress.emplace(std::cerr, true);
  options.on_progress = [&](double done_s, double end_s) {
    throw_if_interrupted();
    if (progress) progress->update(done_s, end_s, "reconstructing");
  };
  Result result;
  result.reconstruction =
      scenarios::reconstruct(*recording, options, [&](const core::Picture& picture, auto tags) {
        if (folder) folder->add(picture, tags);
      });
  if (reference) result.quality = esi::compare(result.reconstruction.last.gray, *reference);
  if (folder) folder->finish(result.json());
  return result;
}

void run_process(const Arguments& arguments) {
  ReconstructProcess process = arguments.process;
  process.options.json = arguments.json;
  process.options.quiet = arguments.quiet;
  process.run(arguments.recording);
}

void run(const Arguments& arguments) {
  if (arguments.list_methods) {
    for (const auto& [name, method] : esi::kMethods) std::cout << name << '\n';
    return;
  }
  if (arguments.process.wanted) return run_process(arguments);
  check(arguments);
  const Result result = naming<scenarios::EmptyRecording>(arguments.recording,
                                                          [&] { return reconstruct(arguments); });
  if (const std::string text = scenarios::warning(result.reconstruction); !text.empty())
    std::cerr << "nightjar: warning: " << text << '\n';
  if (arguments.json)
    std::cout << result.json();
  else if (!arguments.quiet)
    std::cout << result.table();
}

}  // namespace

void add_reconstruct_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("reconstruct", "turn a recording's events into pictures, find tags");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  arguments->process.declare(*command);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
