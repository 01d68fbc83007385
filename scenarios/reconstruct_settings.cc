#include "scenarios/reconstruct_settings.h"

#include <fmt/format.h>

#include "scenarios/moved_name.h"
#include "scenarios/scenario_error.h"
#include "scenarios/yaml_reader.h"

namespace nightjar::scenarios {
namespace fs = std::filesystem;
namespace {

/// "a.b=1" as the YAML document "a:\n b: 1".
std::string as_yaml(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ScenarioError(fmt::format("--set {}: expected NAME=VALUE", shown(assignment)));
  std::string yaml, indent;
  for (const char c : assignment.substr(0, equals)) {
    if (c == '.')
      yaml += ":\n" + (indent += ' ');
    else
      yaml += c;
  }
  return yaml + ": " + assignment.substr(equals + 1) + '\n';
}

}  // namespace

void move_weights(esi::ReconstructorConfig& config, const fs::path& from, const fs::path& to) {
  for (std::string* weights : {&config.firenet.weights, &config.e2vid.weights})
    *weights = moved_name(*weights, from, to);
}

void read_settings(const fs::path& file, ReconstructSettings& settings) {
  ReconstructSettings read;
  read_yaml(read_scenario_text(file), shown_file(file.string()), read);
  move_weights(read.reconstructor, file.parent_path(), fs::current_path());
  settings = read;
}

void apply_setting(const std::string& assignment, ReconstructSettings& settings) {
  read_yaml(as_yaml(assignment), "--set " + shown(assignment), settings);
}

}  // namespace nightjar::scenarios
