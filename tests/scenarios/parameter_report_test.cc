#include "scenarios/parameter_report.h"

#include <gtest/gtest.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/parameter_table.h"
#include "scenarios/scenario.h"

namespace nightjar::scenarios {
namespace {

using nlohmann::json;

json entry(const json& list, const std::string& path) {
  for (const json& each : list)
    if (each["parameter"] == path) return each;
  throw std::out_of_range("no parameter " + path);
}

/// The words of the line that begins with `name`.
std::vector<std::string> line(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string each; std::getline(lines, each);) {
    std::istringstream words(each);
    const std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
    if (!all.empty() && all[0] == name) return all;
  }
  return {};
}

TEST(ParameterReport, text_and_json_list_the_same_parameters) {
  const std::string text = parameters_text();
  const json list = json::parse(parameters_json());
  EXPECT_GT(list.size(), 100u);
  for (const json& each : list) {
    const auto words = line(text, each["parameter"]);
    ASSERT_GE(words.size(), 2u) << each["parameter"];
  }
  EXPECT_EQ(entry(list, "sensor.pixel.cutoff_hz")["only_with"], "sensor.preset = custom");
  EXPECT_FALSE(entry(list, "seed").contains("only_with"));
}

TEST(ParameterReport, json_writes_numbers_as_numbers) {
  const json list = json::parse(parameters_json());
  EXPECT_EQ(entry(list, "illuminance_lux")["default"], 5.0);
  EXPECT_EQ(entry(list, "world.start_from_tag_m")["default"], json({-0.25, 0.15, 1.5}));
  EXPECT_EQ(entry(list, "pass.require_landed")["default"], true);
  EXPECT_EQ(entry(list, "sensor.preset")["default"], "by_illuminance");
  EXPECT_EQ(entry(list, "name")["default"], "unnamed");
  EXPECT_EQ(entry(list, "sensor.imu.accel_range_g")["unit"], "g");
  EXPECT_FALSE(entry(list, "seed").contains("unit"));
}

TEST(ParameterReport, presets_stand_side_by_side) {
  const auto words = [](std::optional<double> lux, const char* name) {
    return line(presets_text(lux), std::string("sensor.pixel.") + name);
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(words({}, "cutoff_hz"), (Words{"sensor.pixel.cutoff_hz", "0", "300", "30", "Hz"}));
  EXPECT_EQ(words(2.0, "cutoff_hz"),
            (Words{"sensor.pixel.cutoff_hz", "0", "300", "30", "12", "Hz"}));
  sim::PixelConfig pixel;
  ParameterTable table("sensor.pixel");
  pixel.visit(table);
  for (const Parameter& each : table.parameters())
    EXPECT_GE(line(presets_text(50.0), each.path).size(), 6u) << each.path;
  EXPECT_THROW(presets_text(0.0), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
