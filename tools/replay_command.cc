#include "tools/replay_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scenarios/step_reader.h"
#include "tools/process_options.h"
#include "tools/recording_options.h"
#include "tools/sensor_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path recording;
  std::optional<std::string> size;
  SourceOptions options;
};

constexpr const char* kExamples = R"(

A LOG is what nightjar run --record-events leaves, or lcm-logger heard of our processes: of
it vehicle states, frames, IMU samples, events and truth are sent. A RECORDING is AEDAT4,
AEDAT 3.1, AEDAT 2.0 or text, sent every 10 ms of its time. Real time is the default; in
lock-step each packet waits for the tracker where there are vehicle states, else for the
reconstruction.

Examples:
  nightjar replay out/landing/run.lcm
  nightjar replay flight.aedat4 --lockstep

Exit codes: 0 all of it sent, 2 bad input, 3 our own fault, 130 stopped by a signal.)";

void run(const Arguments& arguments) {
  std::optional<core::Resolution> size;
  if (arguments.size) size = parse_size(*arguments.size);
  const auto steps = scenarios::open_steps(arguments.recording, size);
  const scenarios::Sending& answers =
      steps->has_vehicle_states() ? scenarios::kFromTracker : scenarios::kFromReconstruction;
  send(arguments.options, arguments.options.lockstep, answers, [&](scenarios::SourceLink& link) {
    while (const auto t = steps->next(link.inside())) {
      link.wait_until_due(*t);
      link.exchange(*t);
    }
  });
  warn(steps->faults());
}

}  // namespace

void add_replay_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("replay", "send a log's or a recording's events over LCM");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  command->add_option("RECORDING", arguments->recording, "a LOG or a RECORDING, see below")
      ->required();
  command
      ->add_option("--size", arguments->size,
                   "of the sensor, for recordings that do not tell it: text, AEDAT 2.0")
      ->type_name("WxH");
  arguments->options.declare(*command);
  command->footer(std::string(kProcessNotes) + kExamples);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
