#include "tools/simulate_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "scenarios/simulate.h"
#include "tools/process_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path scenario;
  std::optional<int> seed;
  SourceOptions options;
};

constexpr const char* kExamples = R"(

Examples:
  nightjar track scenarios/smoke.yaml --json &
  nightjar reconstruct --lcm scenarios/smoke.yaml &
  nightjar simulate scenarios/smoke.yaml                 # lock-step
  nightjar simulate scenarios/smoke.yaml --free-running  # needs a fast computer

In lock-step, the default, the estimates have the bits of nightjar run's.

Exit codes: 0 the flight is over, 2 bad input, 3 our own fault, 130 stopped by a signal.)";

void run(const Arguments& arguments) {
  scenarios::Scenario scenario = scenarios::load(arguments.scenario);
  if (arguments.seed) scenario.seed = *arguments.seed;
  send(arguments.options, !arguments.options.free_running, scenarios::kFromTracker,
       [&](scenarios::SourceLink& link) { scenarios::simulate(scenario, link); });
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("simulate", "the simulator as a process: sends events over LCM");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  command->add_option("SCENARIO", arguments->scenario, "the YAML file that describes the run")
      ->required();
  command->add_option("--seed", arguments->seed, "of all randomness, instead of the scenario's")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  arguments->options.declare(*command);
  command->footer(std::string(kProcessNotes) + kExamples);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
