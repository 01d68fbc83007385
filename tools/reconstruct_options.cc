#include "tools/reconstruct_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "scenarios/choice_text.h"

namespace nightjar::tools {

void declare(CLI::App& command, MethodOptions& options) {
  command
      .add_option("--config", options.config,
                  "take parameters from a YAML file with the sections reconstructor and "
                  "tracker.detector of a scenario")
      ->type_name("FILE.yaml");
  command
      .add_option("--set", options.set,
                  "one parameter, as `nightjar parameters` names it: "
                  "reconstructor.esi.decay_rate_hz=2; may be repeated")
      ->type_name("NAME=VALUE")
      ->take_all();
}

scenarios::ReconstructSettings settings_of(const MethodOptions& options) {
  scenarios::ReconstructSettings settings;
  if (!options.config.empty()) scenarios::read_settings(options.config, settings);
  for (const std::string& assignment : options.set) scenarios::apply_setting(assignment, settings);
  return settings;
}

esi::Method parse_method(const std::string& name) {
  for (const auto& [each, method] : esi::kMethods)
    if (name == each) return method;
  throw std::invalid_argument(
      fmt::format("--method = {}, allowed {}", name, scenarios::choice_names(esi::kMethods)));
}

}  // namespace nightjar::tools
