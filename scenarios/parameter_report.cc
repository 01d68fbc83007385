#include "scenarios/parameter_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "scenarios/parameter_table.h"
#include "scenarios/scenario.h"
#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

using Json = nlohmann::ordered_json;  // members in the order written here
using Rows = std::vector<Parameter>;

constexpr const char* kOnlyCustom = "sensor.preset = custom";

template <class Config>
Rows rows(Config config, const std::string& path) {
  ParameterTable table(path);
  config.visit(table);
  return table.parameters();
}

Rows scenario_rows() { return rows(Scenario{}, ""); }
Rows pixel_rows(const sim::PixelConfig& pixel = {}) { return rows(pixel, "sensor.pixel"); }

/// Numbers, truth values and lists of numbers are written as JSON has them.
Json default_of(const Parameter& parameter) {
  const Json value = Json::parse(parameter.default_value, nullptr, false);
  return value.is_discarded() ? Json(parameter.default_value) : value;
}

Json json(const Parameter& parameter) {
  Json object = {{"parameter", parameter.path},
                 {"default", default_of(parameter)},
                 {"allowed", parameter.allowed}};
  if (!parameter.unit.empty()) object["unit"] = parameter.unit;
  if (!parameter.source.empty()) object["source"] = parameter.source;
  return object;
}

}  // namespace

std::string parameters_text() {
  return fmt::format("{}\nOnly with {}:\n{}", to_text(scenario_rows()), kOnlyCustom,
                     to_text(pixel_rows()));
}

std::string parameters_json() {
  Json list = Json::array();
  for (const Parameter& parameter : scenario_rows()) list.push_back(json(parameter));
  for (const Parameter& parameter : pixel_rows()) {
    list.push_back(json(parameter));
    list.back()["only_with"] = kOnlyCustom;
  }
  return list.dump(2) + '\n';
}

std::string presets_text(std::optional<double> illuminance_lux) {
  using enum sim::SensorPreset;
  std::vector<std::string> names = {"clean", "bright", "dim"};
  std::vector<Rows> columns;
  for (const sim::SensorPreset preset : {clean, bright, dim})
    columns.push_back(pixel_rows(sim::preset_pixel(preset, 1.0)));
  if (illuminance_lux) {
    names.push_back("at " + core::number_text(*illuminance_lux) + " lux");
    columns.push_back(pixel_rows(sim::preset_pixel(by_illuminance, *illuminance_lux)));
  }
  std::vector<std::vector<std::string>> table = {{"parameter"}};
  for (const Parameter& parameter : columns.front()) table.push_back({parameter.path});
  for (std::size_t c = 0; c < columns.size(); ++c) {
    table[0].push_back(names[c]);
    for (std::size_t i = 0; i < columns[c].size(); ++i)
      table[i + 1].push_back(columns[c][i].default_value);
  }
  table[0].push_back("unit");
  for (std::size_t i = 0; i < columns[0].size(); ++i) table[i + 1].push_back(columns[0][i].unit);
  return text_table(table) +
         "\nclean: v2e's clean preset. bright: v2e's command-line defaults. dim: v2e's noisy "
         "preset,\nmeant at 5 lux. Assumption: between them parameters follow the light "
         "(sensor.preset =\nby_illuminance), dim at 5 lux, bright from 1000 lux.\n";
}

}  // namespace nightjar::scenarios
