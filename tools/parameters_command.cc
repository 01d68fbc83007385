#include "tools/parameters_command.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "scenarios/parameter_table.h"
#include "scenarios/scenario.h"

namespace nightjar::tools {

void add_parameters_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "parameters", "list every parameter of a scenario file: name, default, allowed values");
  command->callback([] {
    scenarios::Scenario defaults;
    scenarios::ParameterTable table;
    defaults.visit(table);
    std::cout << to_text(table.parameters());

    scenarios::ParameterTable pixel("sensor.pixel");
    defaults.sensor.pixel.visit(pixel);
    std::cout << "\nOnly with sensor.preset = custom:\n" << to_text(pixel.parameters());
  });
}

}  // namespace nightjar::tools
