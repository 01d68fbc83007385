#include "tools/parameters_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "scenarios/parameter_report.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  bool json = false;
  bool presets = false;
  std::optional<double> illuminance_lux;
};

void print(const Arguments& arguments) {
  if (arguments.presets)
    std::cout << scenarios::presets_text(arguments.illuminance_lux);
  else if (arguments.json)
    std::cout << scenarios::parameters_json();
  else
    std::cout << scenarios::parameters_text();
}

}  // namespace

void add_parameters_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "parameters",
      "list every parameter of a scenario file: name, default, allowed values, unit, source");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  CLI::Option* json = command->add_flag("--json", arguments->json, "the same for scripts");
  CLI::Option* presets = command->add_flag("--presets", arguments->presets,
                                           "instead: the event pixel under each preset");
  presets->excludes(json);
  command
      ->add_option("--illuminance", arguments->illuminance_lux,
                   "adds a column: the pixel as interpolated for this light, in lux")
      ->check(CLI::Range(0.1, 100000.0))
      ->needs(presets)
      ->type_name("LUX");
  command->callback([arguments] { print(*arguments); });
}

}  // namespace nightjar::tools
