#include "tools/convert_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "scenarios/recording_info.h"
#include "scenarios/recordings.h"
#include "tools/recording_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  RecordingOptions recording;
  std::filesystem::path out;
  std::string compression = "lz4";
};

constexpr const char* kNotes = R"(
What a format has no place for is left out and said on stderr, a line for each kind: text holds
events alone, AEDAT4 frames of 8 bits and IMU in floats, AEDAT 3.1 all with IMU in floats, LCM
logs everything; of a flight's log the camera's part is taken. OUT appears when it is complete.

Examples:
  nightjar convert road.aedat4 road.aedat         (AEDAT 3.1)
  nightjar convert events.txt events.aedat4 --size 346x260 --compression zstd
  nightjar convert davis.aedat davis.txt
  nightjar convert out/landing/run.lcm landing.aedat4
  nightjar convert road.aedat4 road.lcm           (an LCM log, for nightjar replay too)

Exit codes: 0 done, 2 bad input, 3 our own fault or the disk's, 130 interrupted.)";

void declare(CLI::App& command, Arguments& arguments) {
  declare(command, arguments.recording, "IN");
  command
      .add_option("OUT", arguments.out,
                  "a name ending in .aedat4, .aedat (AEDAT 3.1), .txt or .lcm")
      ->required();
  command.add_option("--compression", arguments.compression, "of AEDAT4: lz4, zstd or none")
      ->capture_default_str()
      ->type_name("NAME");
  command.footer(kNotes);
}

camera::Compression parse_compression(const std::string& name) {
  if (name == "lz4") return camera::Compression::lz4;
  if (name == "zstd") return camera::Compression::zstd;
  if (name == "none") return camera::Compression::none;
  throw std::invalid_argument(fmt::format("--compression = {}, allowed lz4, zstd and none", name));
}

void run(const Arguments& arguments) {
  scenarios::check_recording_name("OUT", arguments.out);
  const camera::Compression compression = parse_compression(arguments.compression);
  const auto in = open(arguments.recording);
  const auto out =
      scenarios::create_recording(arguments.out, {in->size(), in->camera()}, compression);
  std::uint64_t events = 0;
  {
    const auto on_progress = progress_of(arguments.recording, "converting");
    for (camera::RecordingPart part; in->next(part);) {
      out->write(part);
      events += part.events.size();
      on_progress(in->progress());
    }
  }
  out->finish();
  warn(scenarios::fault_text(in->faults()));
  for (const std::string& thing : out->not_carried().things())
    warn(fmt::format("{} cannot carry {}", arguments.out.string(), thing));
  for (const auto& [channel, messages] : in->others())
    warn(fmt::format("left out {} messages {}", messages, channel));
  if (!arguments.recording.quiet)
    std::cout << fmt::format("{} events, {} to {}\n", events, in->format(), arguments.out.string());
}

}  // namespace

void add_convert_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("convert", "write a recording in another format");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
