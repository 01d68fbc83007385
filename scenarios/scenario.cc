#include "scenarios/scenario.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/config_check.h"
#include "scenarios/consistency.h"
#include "scenarios/corner_inset.h"
#include "scenarios/intrinsics.h"
#include "scenarios/mount.h"
#include "scenarios/moved_name.h"
#include "scenarios/reconstruct_settings.h"
#include "scenarios/yaml_reader.h"
#include "scenarios/yaml_writer.h"

namespace nightjar::scenarios {
namespace fs = std::filesystem;
namespace {

// "dark.yaml:3:1" for a top-level key that stands in the document, else "dark.yaml".
std::string place_of(const std::string& key, const YamlNode& root, const std::string& file) {
  for (const YamlNode& member : root.children)
    if (member.key == key) return fmt::format("{}:{}:{}", file, member.line, member.column);
  return file;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::string no_model(const std::string& model) {
  return model.empty() ? "model is not set, expected an MJCF file"
                       : fmt::format("model = {}, no such file", shown_file(model));
}

// Names its files, which are meant from the folder `from`, as from `to`.
void move_files(Scenario& scenario, const fs::path& from, const fs::path& to) {
  for (std::string* file : {&scenario.model, &scenario.source.intrinsics})
    *file = moved_name(*file, from, to);
  move_weights(scenario.reconstructor, from, to);
}

// The simulator flies in it; a camera has the world itself.
bool needs_model(const Scenario& scenario) {
  return scenario.source.type == camera::SourceType::simulation;
}

// The pixels that the preset stands for, which the file itself does not hold. Without
// the "# " it is what sensor.preset = custom takes.
std::string pixel_comment(const Scenario& scenario) {
  const std::string pixel =
      to_yaml(sim::effective_pixel(scenario.sensor, scenario.illuminance_lux));
  std::string comment = "\n# sensor.pixel, as the preset makes it:\n";
  for (std::size_t begin = 0; begin < pixel.size();) {
    const std::size_t end = pixel.find('\n', begin) + 1;
    comment += "#   " + pixel.substr(begin, end - begin);
    begin = end;
  }
  return comment;
}

void read(const YamlNode& root, const std::string& file, Scenario& scenario) {
  YamlReader reader(root, file, "");
  scenario.visit(reader);
  reader.finish();
}

// What suits the method, for a file that does not say it itself.
Scenario defaults_for(esi::Method method) {
  Scenario scenario;
  scenario.tracker.measurement.corner_inset_px = corner_inset_px(method);
  return scenario;
}

}  // namespace

Scenario load(const fs::path& path) { return parse(read_scenario_text(path), path); }

Scenario parse(const std::string& text, const fs::path& path) {
  const std::string file = shown_file(path.string());
  const YamlNode root = parse_yaml(text, file);
  Scenario scenario;
  read(root, file, scenario);  // for the method
  scenario = defaults_for(scenario.reconstructor.method);
  read(root, file, scenario);
  const fs::path model = path.parent_path() / scenario.model;
  if (needs_model(scenario) && (scenario.model.empty() || !is_file(model)))
    throw ScenarioError(place_of("model", root, file) + ": " + no_model(scenario.model));
  move_files(scenario, path.parent_path(), fs::current_path());
  try {
    check(scenario);
  } catch (const std::invalid_argument& error) {  // a default, or values that do not fit
    throw ScenarioError(file + ": " + error.what());
  }
  return scenario;
}

void check(const Scenario& scenario) {
  try {
    core::check_config(scenario, "");
  } catch (const std::invalid_argument& error) {
    throw ScenarioError(error.what());
  }
  check_consistency(scenario);
  check_intrinsics(scenario);
  check_mount(scenario);
  if (needs_model(scenario) && !is_file(scenario.model))
    throw ScenarioError(no_model(scenario.model));
}

void save(const Scenario& scenario, const fs::path& path) {
  Scenario copy = scenario;
  move_files(copy, fs::current_path(), fs::absolute(path).parent_path());
  std::ofstream stream(path, std::ios::binary);
  stream << to_yaml(copy);
  if (copy.sensor.preset != sim::SensorPreset::custom) stream << pixel_comment(copy);
  stream.close();
  if (!stream) throw ScenarioError(shown_file(path.string()) + ": cannot be written");
}

}  // namespace nightjar::scenarios
