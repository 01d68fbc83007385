#include "tools/quality_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/gray_picture.h"
#include "scenarios/score_methods.h"
#include "tools/interrupt.h"
#include "tools/reconstruct_options.h"
#include "tools/recording_options.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  RecordingOptions recording;
  std::string reference;
  std::vector<std::string> methods;
  double fps = 100;
  scenarios::FrameChoice choice;
  std::optional<double> until_s;
  MethodOptions options;
  bool json = false;
};

constexpr const char* kNotes = R"(
Without --reference each of the recording's own frames is compared with the picture at the
middle of its exposure, made of the events up to then (and, of methods that use frames, of
those whose exposure had ended), and the numbers are averaged. Left out and counted: frames
before --from, when a method has hardly had an event at most pixels; frames exposed for more
than --max-exposure, in which what moves is blurred; frames without an event after them, of
part of the sensor, or of one grey level. Frames after --until are not counted. With
--reference the picture at the last event is compared with PICTURE, whose size is the sensor's.
At 5 lux a frame takes half a second: --max-exposure 500 compares with such frames, blurred as
they are: a picture sharper than its reference loses by that.

Pictures are compared after the affine change of grey levels (gain not negative) that fits
them best; a gain of 0 says that the picture's levels do not go with the reference's at all.
explained: the share of the reference's variance that the picture accounts for,
1 - MSE / variance, 0 to 1, which also compares recordings with each other. Where the camera
stands still an earlier frame explains nearly all of a later one: "made of" says who saw one.

Each picture of a network is a step that changes all later ones, so a network makes N a
second, spaced such that one falls on the middle of every frame. Skipped, and said so:
networks without weights, EDI and FEDI where no frame came before the last one compared (where
one did, their means hold comparisons before it, of events alone, too).

Examples:
  nightjar quality flight.aedat4
  nightjar quality flight.aedat4 --max-exposure 500 --from 1 --json
  nightjar quality events.txt --reference frame.png
  nightjar quality flight.aedat4 --method esi --method firenet \
                   --set reconstructor.firenet.weights=firenet.onnx

Exit codes: 0 done, 2 bad input, 3 our own fault, 130 interrupted.)";

void declare_references(CLI::App& command, Arguments& arguments) {
  auto* reference = command
                        .add_option("--reference", arguments.reference,
                                    "a picture of the same view instead of the recording's frames")
                        ->type_name("PICTURE")
                        ->excludes(command.get_option("--size"));
  command
      .add_option("--from", arguments.choice.from_s,
                  "compare no frame earlier than this after the first event")
      ->capture_default_str()
      ->excludes(reference)
      ->type_name("S");
  command
      .add_option("--max-exposure", arguments.choice.max_exposure_ms,
                  "compare no frame exposed for longer")
      ->capture_default_str()
      ->excludes(reference)
      ->type_name("MS");
  command
      .add_option("--until", arguments.until_s,
                  "compare no frame later than this after the first event; with --reference: "
                  "compare at this time")
      ->type_name("S");
}

void declare(CLI::App& command, Arguments& arguments) {
  declare(command, arguments.recording, "RECORDING");
  declare_references(command, arguments);
  command.add_option("--method", arguments.methods, "one method; may be repeated; default all")
      ->take_all()
      ->type_name("NAME");
  command.add_option("--fps", arguments.fps, "pictures a second: how the networks advance")
      ->capture_default_str()
      ->type_name("N");
  declare(command, arguments.options);
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.footer(kNotes);
}

scenarios::ScoreOptions options_of(const Arguments& arguments) {
  scenarios::ScoreOptions options;
  options.reconstructor = settings_of(arguments.options).reconstructor;
  for (const std::string& name : arguments.methods) options.methods.push_back(parse_method(name));
  if (options.methods.empty())
    for (const auto& [name, method] : esi::kMethods) options.methods.push_back(method);
  options.rate_hz = arguments.fps;
  options.until_s = arguments.until_s;
  return options;
}

scenarios::MethodScores scores_of(const Arguments& arguments) {
  scenarios::ScoreOptions options = options_of(arguments);
  note_interrupts();
  options.on_progress = progress_of(arguments.recording, "comparing");  // its bar ends with this
  const std::string& path = arguments.recording.path;
  if (!arguments.reference.empty())
    return score_against_picture(path, scenarios::read_gray_picture(arguments.reference), options);
  std::optional<core::Resolution> size;
  if (arguments.recording.size) size = parse_size(*arguments.recording.size);
  return score_against_frames(path, size, options, arguments.choice);
}

void run(const Arguments& arguments) {
  const scenarios::MethodScores scores = scores_of(arguments);
  warn(scores.first_fault);
  if (arguments.json)
    std::cout << to_json(scores);
  else if (!arguments.recording.quiet)
    std::cout << to_table(scores);
}

}  // namespace

void add_quality_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "quality", "compare each method's pictures of a recording with its frames or a picture");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
