#include "tools/calibrate_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/config_check.h"
#include "core/part_file.h"
#include "scenarios/board_search.h"
#include "scenarios/calibration_plot.h"
#include "scenarios/calibration_views.h"
#include "scenarios/gnuplot.h"
#include "tools/interrupt.h"
#include "tools/reconstruct_options.h"
#include "tools/recording_options.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  RecordingOptions source;
  std::string board;
  std::string corners = "9x6";
  double square_m = 0.03;
  std::string layout;
  std::string method;
  double fps = 10;
  MethodOptions options;
  bool frames = false;
  std::size_t views = 40;
  scenarios::CalibrationOptions calibration;
  fs::path out;
  bool json = false;
};

constexpr const char* kNotes = R"(
Move the board slowly: to the picture's rim and corners, near and far, tilted by 20 to 40 degrees
each way. Events need motion; frames need the board held still. At least 8 views that differ are
needed, 20 to 40 are good; a warning says what is amiss.

A layout lists the tags of a board (family 36h11), all on one plane and printed upright; x_m and
y_m lead from the board's origin to a tag's middle, up and to the left; size_m is the side of the
black square:
  tags:
    - {id: 0, size_m: 0.08, x_m: 0, y_m: 0}
    - {id: 1, size_m: 0.08, x_m: 0, y_m: -0.1}
Without a layout the board is the landing board's one tag: id 0, 0.24 m.

FILE.yaml is what a scenario reads, source: {type: caer, intrinsics: FILE.yaml}; FILE.png beside it
shows where the views lie and how well they fit. Lengths only set the poses' scale: a square that is
1 % off changes no intrinsics.

Examples:
  nightjar calibrate board.aedat4 --board checkerboard --corners 9x6 --square-m 0.03 --out camera.yaml
  nightjar calibrate board.aedat4 --board checkerboard --frames --out camera.yaml
  nightjar calibrate board.aedat4 --board tags --layout tags.yaml --method esi --fps 20 --out camera.yaml
  nightjar calibrate pictures --board checkerboard --corners 7x5 --k3 --out camera.yaml --json

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, 130 interrupted.)";

void declare_board(CLI::App& command, Arguments& arguments) {
  command.add_option("--board", arguments.board, "checkerboard or tags")
      ->required()
      ->check(CLI::IsMember({"checkerboard", "tags"}));
  command
      .add_option("--corners", arguments.corners,
                  "of a checkerboard: inner corners, columns x rows")
      ->capture_default_str()
      ->type_name("CxR");
  command.add_option("--square-m", arguments.square_m, "of a checkerboard: a square's side")
      ->capture_default_str()
      ->type_name("M");
  command.add_option("--layout", arguments.layout, "of a tag board, see below")
      ->type_name("FILE.yaml");
}

void declare(CLI::App& command, Arguments& arguments) {
  declare(command, arguments.source, "SOURCE");
  command.get_option("SOURCE")->description(
      "a recording (AEDAT4, AEDAT 3.1, AEDAT 2.0, text, an LCM log of ours) or a folder of "
      "pictures");
  declare_board(command, arguments);
  command.add_option("--out", arguments.out, "the intrinsics; a .png of the same name beside it")
      ->required()
      ->type_name("FILE.yaml");
  command
      .add_option("--method", arguments.method,
                  "how events become pictures; see nightjar reconstruct --list-methods")
      ->type_name("NAME");
  command.add_option("--fps", arguments.fps, "pictures a second from events, 0.01 to 100000")
      ->capture_default_str()
      ->type_name("N");
  declare(command, arguments.options);
  command.add_flag("--frames", arguments.frames, "use the recording's frames, not its events");
  command.add_option("--views", arguments.views, "use at most so many that differ most")
      ->capture_default_str()
      ->check(CLI::Range(scenarios::kLeastViews, std::size_t{1000}))
      ->type_name("N");
  command.add_flag("--k3", arguments.calibration.k3,
                   "estimate k3, too: for lenses that see 90 degrees or more");
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.footer(kNotes);
}

/// Throws when one of `options` was given, though it is for `what`.
void refuse_unless(const std::string& what, const CLI::App& command,
                   std::initializer_list<const char*> options) {
  for (const char* option : options)
    if (command.count(option) > 0)
      throw std::invalid_argument(fmt::format("{} is for {}", option, what));
}

bool is_folder(const Arguments& arguments) {
  std::error_code ignored;
  return fs::is_directory(arguments.source.path, ignored);
}

void check(const CLI::App& command, const Arguments& arguments) {
  if (arguments.out.extension() != ".yaml")
    throw std::invalid_argument(
        fmt::format("--out = {}, allowed a name ending in .yaml", arguments.out.string()));
  core::check_range("--fps", arguments.fps, 0.01, 100000);
  if (arguments.board == "tags")
    refuse_unless("--board checkerboard", command, {"--corners", "--square-m"});
  else
    refuse_unless("--board tags", command, {"--layout"});
  if (is_folder(arguments))
    refuse_unless("recordings, not for a folder of pictures", command,
                  {"--method", "--fps", "--frames", "--size"});
  if (arguments.frames) refuse_unless("events, not for --frames", command, {"--method", "--fps"});
}

/// "9x6".
scenarios::Checkerboard checkerboard_of(const Arguments& arguments) {
  scenarios::Checkerboard board{0, 0, arguments.square_m};
  const std::string& text = arguments.corners;
  const char* const end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, board.columns);
  const bool has_rows = columns.ec == std::errc() && columns.ptr != end && *columns.ptr == 'x';
  const auto rows = has_rows ? std::from_chars(columns.ptr + 1, end, board.rows) : columns;
  if (!has_rows || rows.ec != std::errc() || rows.ptr != end)
    throw std::invalid_argument(
        fmt::format("--corners = {}, expected columns and rows, 9x6", text));
  return board;
}

std::unique_ptr<scenarios::BoardFinder> finder_of(const Arguments& arguments) {
  if (arguments.board == "checkerboard")
    return make_checkerboard_finder(checkerboard_of(arguments));
  const tracker::DetectorConfig detector = settings_of(arguments.options).tracker.detector;
  if (arguments.layout.empty()) return scenarios::make_tag_board_finder({}, detector);
  const scenarios::TagBoardConfig layout = scenarios::read_tag_board(arguments.layout);
  return naming(arguments.layout, [&] { return make_tag_board_finder(layout, detector); });
}

scenarios::BoardSearch search(const Arguments& arguments, scenarios::BoardFinder& finder) {
  const auto progress = progress_of(arguments.source, "looking for the board");
  if (is_folder(arguments)) return search_pictures(arguments.source.path, finder, progress);
  const auto recording = open(arguments.source);
  if (arguments.frames) return search_frames(*recording, finder, progress);
  scenarios::ReconstructOptions options;
  options.reconstructor = settings_of(arguments.options).reconstructor;
  if (!arguments.method.empty()) options.reconstructor.method = parse_method(arguments.method);
  options.rate_hz = arguments.fps;
  return search_events(*recording, options, finder, progress);
}

scenarios::CalibrationReport calibrate(const Arguments& arguments) {
  const auto finder = finder_of(arguments);
  const std::string& source = arguments.source.path;
  const scenarios::BoardSearch found =
      naming<scenarios::EmptyRecording>(source, [&] { return search(arguments, *finder); });
  warn(found.warning);
  const auto views = choose_views(found.views, found.size, arguments.views);
  if (views.size() < scenarios::kLeastViews)
    throw std::invalid_argument(fmt::format(
        "{}: the board is in {} of {} pictures, {} of these views differ, expected at least {}",
        source, found.views.size(), found.pictures, views.size(), scenarios::kLeastViews));
  return {fs::path(source).filename().string(), found.pictures, found.views.size(),
          naming(source, [&] { return calibrate(views, found.size, arguments.calibration); })};
}

void run(const CLI::App& command, const Arguments& arguments) {
  note_interrupts();  // before there is anything to leave behind
  check(command, arguments);
  scenarios::run_gnuplot("");  // fails before the work, not after it
  core::PartFile intrinsics(arguments.out);
  core::PartFile picture(fs::path(arguments.out).replace_extension(".png"));
  const scenarios::CalibrationReport report = calibrate(arguments);
  intrinsics.stream() << naming(arguments.source.path, [&] { return to_intrinsics_yaml(report); });
  picture.stream() << draw_png(report);
  intrinsics.check();
  picture.finish();
  intrinsics.finish();
  for (const std::string& line : advice(report)) warn(line);
  if (arguments.json)
    std::cout << to_json(report);
  else if (!arguments.source.quiet)
    std::cout << to_table(report);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("calibrate", "find a camera's intrinsics from views of a board");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([command, arguments] { run(*command, *arguments); });
}

}  // namespace nightjar::tools
