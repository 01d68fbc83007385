#include "tools/track_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "scenarios/processes.h"
#include "tools/process_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path scenario;
  ProcessOptions options;
};

constexpr const char* kExamples = R"(

Vehicle states come from the source or from a bridge to a flight controller, setpoints go
to it: docs/vehicle-messages.md. The scenario tells the camera, where it sits and what the
tracker is to do; estimates_sha256 in the JSON is comparable to summary.json's.

Example:
  nightjar track scenarios/tracking_landing.yaml --json > track.json

Exit codes: 0 stopped by SIGINT or SIGTERM, 2 bad input, 3 our own fault.)";

void run(const Arguments& arguments) {
  std::string estimates_sha256;
  const scenarios::Scenario scenario = scenarios::load(arguments.scenario);
  serve(arguments.options, scenarios::tracker_process(scenario, estimates_sha256),
        &estimates_sha256);
}

}  // namespace

void add_track_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("track", "the tracker as a process: pictures in, setpoints out, over LCM");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  command->add_option("SCENARIO", arguments->scenario, "the YAML file that describes the run")
      ->required();
  arguments->options.declare(*command);
  command->footer(std::string(kProcessNotes) + kExamples);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
