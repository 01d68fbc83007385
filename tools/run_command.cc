#include "tools/run_command.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "scenarios/loop.h"
#include "scenarios/scenario.h"
#include "scenarios/summary.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::filesystem::path scenario;
  std::filesystem::path out;
  std::optional<int> seed;
  bool no_video = false;
  bool record_events = false;
  bool profile = false;
  bool json = false;
  bool quiet = false;
};

constexpr const char* kExamples = R"(
Examples:
  nightjar run scenarios/tracking_landing.yaml --out out/landing
  nightjar run scenarios/tracking_landing.yaml --out out/seed7 --seed 7 --no-video
  nightjar run scenarios/smoke.yaml --out out/smoke --json --quiet | jq .detection_rate

Exit codes: 0 the scenario's pass criteria hold, 1 they do not, 2 bad input,
3 our own fault or the disk's, 130 interrupted. DIR holds a whole run exactly when it holds summary.json.)";

void declare(CLI::App& command, Arguments& arguments) {
  command.add_option("SCENARIO", arguments.scenario, "the YAML file that describes the run")
      ->required();
  command.add_option("--out", arguments.out, "folder for the results, made where needed")
      ->required()
      ->type_name("DIR");
  command.add_option("--seed", arguments.seed, "of all randomness, instead of the scenario's")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  command.add_flag("--no-video", arguments.no_video, "leave out run.mp4, which takes time");
  command.add_flag("--record-events", arguments.record_events,
                   "add the raw events to run.lcm: about a gigabyte a minute");
  command.add_flag("--profile", arguments.profile,
                   "print what each stage of the loop took (wall time), also with --quiet; with "
                   "--json it is in the JSON anyway");
  command.add_flag("--json", arguments.json, "print summary.json instead of a table");
  command.add_flag("--quiet", arguments.quiet, "no progress, no log, no table");
  command.footer(kExamples);
}

// The run's log goes to stderr, so that stdout holds the result alone, and first
// clears the line that the progress bar draws.
void set_up_log(bool is_terminal, bool quiet) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("nightjar"));
  spdlog::set_pattern(is_terminal ? "\r\033[K%v" : "%v");
  if (quiet) spdlog::set_level(spdlog::level::warn);
}

int run(const Arguments& arguments) {
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  set_up_log(is_terminal, arguments.quiet);
  scenarios::Scenario scenario = scenarios::load(arguments.scenario);
  if (arguments.seed) scenario.seed = *arguments.seed;

  std::optional<ProgressBar> progress;
  if (!arguments.quiet) progress.emplace(std::cerr, is_terminal);

  scenarios::RunOptions options;
  options.out = arguments.out;
  options.video = !arguments.no_video;
  options.record_events = arguments.record_events;
  options.on_progress = [&](double sim_time_s, double end_s, const std::string& phase) {
    throw_if_interrupted();
    if (progress) progress->update(sim_time_s, end_s, phase);
  };
  note_interrupts();
  const scenarios::Summary summary = scenarios::run(scenario, options);
  progress.reset();

  if (arguments.json)
    std::cout << to_json(summary);
  else if (!arguments.quiet)
    std::cout << to_table(summary);
  if (arguments.profile && !arguments.json)
    std::cout << (arguments.quiet ? "" : "\n") << profile_table(summary);
  return summary.passed ? kPassed : kFailed;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "fly one scenario and score it");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare(*command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace nightjar::tools
