#include "tools/view_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/part_file.h"
#include "scenarios/recording_info.h"
#include "scenarios/recording_view.h"
#include "tools/recording_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  RecordingOptions recording;
  scenarios::RecordingViewOptions view;
  std::filesystem::path out;
};

constexpr const char* kNotes = R"(
ON events are green, OFF events red, on the last frame of the active pixels, dimmed; that frame
is drawn beside them as it is. A recording without frames is drawn on grey.

Examples:
  nightjar view road.aedat4 --at 0.1 --out road.png
  nightjar view events.txt --at 2.5 --span 0.03 --out moment.png

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, 130 interrupted.)";

void declare(CLI::App& command, Arguments& arguments) {
  declare(command, arguments.recording, "FILE");
  command.add_option("--at", arguments.view.at_s, "seconds after the first event")
      ->required()
      ->type_name("S");
  command.add_option("--span", arguments.view.span_s, "how long events are gathered from then on")
      ->capture_default_str()
      ->type_name("S");
  command.add_option("--out", arguments.out, "a name ending in .png")
      ->required()
      ->type_name("FILE.png");
  command.footer(kNotes);
}

void run(Arguments& arguments) {
  if (arguments.out.extension() != ".png")
    throw std::invalid_argument(
        fmt::format("--out = {}, allowed a name ending in .png", arguments.out.string()));
  const auto recording = open(arguments.recording);
  core::PartFile file(arguments.out);
  arguments.view.on_progress = progress_of(arguments.recording, "reading");
  const scenarios::RecordingView view = scenarios::draw_recording(*recording, arguments.view);
  arguments.view.on_progress = nullptr;
  file.stream() << view.png;
  file.finish();
  warn(scenarios::fault_text(recording->faults()));
  if (!arguments.recording.quiet)
    std::cout << fmt::format("{} events{}\n", view.events,
                             view.has_frame ? "" : ", no frame before them");
}

}  // namespace

void add_view_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("view", "draw a moment of a recording");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
