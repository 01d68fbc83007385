#include "tools/info_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scenarios/recording_info.h"
#include "tools/recording_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  RecordingOptions recording;
  bool json = false;
};

constexpr const char* kNotes = R"(
Times are the recording's own, in AEDAT4 Unix time. What could not be read as it stood (a
truncated end, packets of unknown type, events off the sensor or out of order, resets of the
clock) is counted; the exit code is 0 all the same.

Examples:
  nightjar info road.aedat4
  nightjar info road.aedat4 --json | jq .events.count
  nightjar info events.txt --size 346x260

Exit codes: 0 done, 2 bad input, 3 our own fault, 130 interrupted.)";

void run(const Arguments& arguments) {
  const auto recording = open(arguments.recording);
  const scenarios::RecordingInfo info =
      scenarios::inspect(*recording, progress_of(arguments.recording, "reading"));
  if (arguments.json)
    std::cout << to_json(info);
  else if (!arguments.recording.quiet)
    std::cout << to_table(info);
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "say what is in a recording");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, arguments->recording, "FILE");
  command->add_flag("--json", arguments->json, "print JSON instead of a table");
  command->footer(kNotes);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
