#include "tools/quality_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/gray_picture.h"
#include "scenarios/method_scores.h"
#include "tools/reconstruct_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::string recording;
  std::string reference;
  std::vector<std::string> methods;
  double fps = 100;
  std::optional<double> until_s;
  MethodOptions options;
  bool json = false;
};

constexpr const char* kNotes = R"(
Each method's picture at the last event is compared with PICTURE, whose size is the sensor's,
after the affine change of grey levels (gain not negative) that fits it best; a gain of 0
says that the picture's levels do not go with the reference's at all. Skipped, and
said so: networks without weights, and EDI and FEDI where the recording holds no frames, for
then only the reference itself could be their input.

Examples:
  nightjar quality events.txt --reference frame.png
  nightjar quality events.txt --reference frame.png --method esi --method firenet \
                   --set reconstructor.firenet.weights=firenet.onnx --json

Exit codes: 0 done, 2 bad input, 3 our own fault.)";

void declare(CLI::App& command, Arguments& arguments) {
  command.add_option("RECORDING", arguments.recording, "as `nightjar reconstruct` takes it")
      ->required();
  command.add_option("--reference", arguments.reference, "a frame of the same view")
      ->required()
      ->type_name("PICTURE");
  command.add_option("--method", arguments.methods, "one method; may be repeated; default all")
      ->take_all()
      ->type_name("NAME");
  command.add_option("--fps", arguments.fps, "pictures a second: how the networks advance")
      ->capture_default_str()
      ->type_name("N");
  command.add_option("--until", arguments.until_s, "compare this long after the first event")
      ->type_name("S");
  declare(command, arguments.options);
  command.add_flag("--json", arguments.json, "print JSON instead of a table");
  command.footer(kNotes);
}

scenarios::MethodScoresOptions options_of(const Arguments& arguments) {
  scenarios::MethodScoresOptions options;
  options.reconstructor = settings_of(arguments.options).reconstructor;
  for (const std::string& name : arguments.methods) options.methods.push_back(parse_method(name));
  if (options.methods.empty())
    for (const auto& [name, method] : esi::kMethods) options.methods.push_back(method);
  options.rate_hz = arguments.fps;
  options.until_s = arguments.until_s;
  return options;
}

void run(const Arguments& arguments) {
  const scenarios::MethodScoresOptions options = options_of(arguments);
  const auto reference = scenarios::read_gray_picture(arguments.reference);
  const auto scores = scenarios::score_methods(arguments.recording, reference, options);
  std::cout << (arguments.json ? to_json(scores) : to_table(scores));
}

}  // namespace

void add_quality_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "quality", "compare each method's picture of a recording with a reference");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
