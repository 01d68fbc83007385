#include "tools/trial_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "scenarios/choice_text.h"
#include "scenarios/trial_report.h"
#include "tools/interrupt.h"
#include "tools/progress_bar.h"
#include "tools/reconstruct_options.h"

namespace nightjar::tools {
namespace {

struct Arguments {
  std::string model;
  std::vector<std::string> methods = {"esi"};
  std::vector<std::string> motions;
  std::vector<double> illuminances_lux = {2, 5, 10, 1000};
  std::vector<int> seeds = {1};
  double duration_s = 4.0;
  int score_every = 4;
  MethodOptions options;
  bool json = false;
};

constexpr const char* kExamples = R"(Examples:
  nightjar trial models/arena.xml --method esi --method accumulator --seed 1 --seed 2
  nightjar trial models/arena.xml --method "esi decay_rate_hz=0.5" --method "esi decay_rate_hz=2"
  nightjar trial models/arena.xml --method "firenet weights=firenet.onnx" --motion hover --json)";

void declare_trial(CLI::App& command, Arguments& arguments) {
  command.add_option("MODEL", arguments.model, "the scene, a MJCF file with a tag and a camera")
      ->required();
  command
      .add_option("--method", arguments.methods,
                  "a method to try, with parameters of its own if wanted; may be repeated")
      ->type_name("NAME")
      ->take_all()
      ->capture_default_str();
  command.add_option("--motion", arguments.motions, "hover, slow, fast, shake; default all four")
      ->type_name("NAME")
      ->take_all();
  command.add_option("--illuminance", arguments.illuminances_lux, "of a white surface, 0.1 to 1e5")
      ->check(CLI::Range(0.1, 1e5))
      ->type_name("LUX")
      ->take_all()
      ->capture_default_str();
  command.add_option("--seed", arguments.seeds, "of a path and its noise; may be repeated")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()))
      ->type_name("N")
      ->take_all()
      ->capture_default_str();
  command.add_option("--duration", arguments.duration_s, "of each sequence, 1.1 to 600")
      ->type_name("S")
      ->capture_default_str();
  command
      .add_option("--score-every", arguments.score_every, "look for the tag in each N-th picture")
      ->type_name("N")
      ->capture_default_str();
  declare(command, arguments.options);
  command.add_flag("--json", arguments.json, "print every score as JSON instead of a table");
  command.footer(kExamples);
}

/// Throws for a value that is given twice.
template <class T>
void check_once(const char* option, const std::vector<T>& values) {
  std::set<T> seen;
  for (const T& value : values)
    if (!seen.insert(value).second) {
      std::ostringstream text;
      text << option << " = " << value << ", allowed once";
      throw std::invalid_argument(text.str());
    }
}

sim::CarryMotion parse_motion(const std::string& name) {
  for (const auto& [each, motion] : sim::kCarryMotions)
    if (name == each) return motion;
  throw std::invalid_argument("--motion = " + name + ", allowed " +
                              scenarios::choice_names(sim::kCarryMotions));
}

/// "esi decay_rate_hz=0.5 decay_power=2": a method, then parameters of its own.
scenarios::TrialEntry parse_entry(const std::string& text,
                                  scenarios::ReconstructSettings settings) {
  std::istringstream words(text);
  std::string method;
  words >> method;
  settings.reconstructor.method = parse_method(method);
  for (std::string assignment; words >> assignment;)
    scenarios::apply_setting("reconstructor." + method + '.' + assignment, settings);
  return {text, settings.reconstructor};
}

std::vector<scenarios::TrialEntry> entries_of(const Arguments& arguments,
                                              const scenarios::ReconstructSettings& settings) {
  std::vector<scenarios::TrialEntry> entries;
  check_once("--method", arguments.methods);
  for (const std::string& text : arguments.methods) entries.push_back(parse_entry(text, settings));
  return entries;
}

scenarios::TrialConfig config_of(const Arguments& arguments,
                                 const scenarios::ReconstructSettings& settings) {
  scenarios::TrialConfig config;
  config.model = arguments.model;
  config.detector = settings.tracker.detector;
  check_once("--motion", arguments.motions);
  check_once("--illuminance", arguments.illuminances_lux);
  check_once("--seed", arguments.seeds);
  if (!arguments.motions.empty()) config.motions.clear();
  for (const std::string& name : arguments.motions) config.motions.push_back(parse_motion(name));
  config.illuminances_lux = arguments.illuminances_lux;
  config.seeds.assign(arguments.seeds.begin(), arguments.seeds.end());
  config.duration_s = arguments.duration_s;
  config.score_every = arguments.score_every;
  return config;
}

void run(const Arguments& arguments) {
  const scenarios::ReconstructSettings settings = settings_of(arguments.options);
  const scenarios::TrialConfig config = config_of(arguments, settings);
  const std::vector<scenarios::TrialEntry> entries = entries_of(arguments, settings);
  note_interrupts();
  std::optional<ProgressBar> progress;
  if (isatty(STDERR_FILENO) != 0) progress.emplace(std::cerr, true);
  const auto scores =
      scenarios::run_trial(config, entries, [&](int done, int all, const std::string& sequence) {
        throw_if_interrupted();
        if (progress) progress->update(static_cast<double>(done) / all, sequence);
      });
  progress.reset();
  std::cout << (arguments.json ? scenarios::trial_json(scores)
                               : scenarios::trial_table(config, entries, scores));
}

}  // namespace

void add_trial_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "trial", "tries reconstruction methods on simulated sequences whose truth is known");
  auto arguments = std::make_shared<Arguments>();  // lives as long as the callback
  declare_trial(*command, *arguments);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace nightjar::tools
