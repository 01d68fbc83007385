#include "tools/camera_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "camera/caer_camera.h"
#include "scenarios/scenario.h"
#include "scenarios/send_camera.h"
#include "scenarios/source_check.h"
#include "tools/interrupt.h"
#include "tools/process_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path scenario;
  ProcessOptions options;
};

constexpr const char* kExamples = R"(

A camera does not wait: each packet goes out when it comes. What the camera saw and lost
stands in the same lines; a camera that goes away is looked for until it is back. Latency
counts from when the packet came off the bus; that of the setpoints is track's to tell.

The SCENARIO says source: {type: caer} and how to set the camera up (docs/hardware.md); it
needs no model. Nightjar must have been built where libcaer is.

Examples:
  nightjar track flight.yaml --json > track.json &
  nightjar reconstruct --lcm flight.yaml &
  nightjar camera flight.yaml
  nightjar camera flight.yaml --quiet --json > camera.json  # until SIGTERM

Exit codes: 0 stopped by SIGINT or SIGTERM, 2 bad input, no camera or no libcaer, 3 our own
fault.)";

void run(const Arguments& arguments) {
  const scenarios::Scenario scenario = scenarios::load(arguments.scenario);
  check_source(scenario, camera::SourceType::caer);
  camera::CaerCamera camera(scenario.source.caer);
  try {
    send(arguments.options, /*lock_step=*/false, std::nullopt,
         [&](scenarios::SourceLink& link) { scenarios::send_camera(camera, link); });
  } catch (const Interrupted&) {  // how it is meant to end
  }
}

}  // namespace

void add_camera_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("camera", "a DAVIS346 as a process: sends its events over LCM");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  command->add_option("SCENARIO", arguments->scenario, "the YAML file that describes the run")
      ->required();
  arguments->options.declare(*command);
  command->footer(std::string(kProcessNotes) + kExamples);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
