#include "scenarios/parameter_table.h"

#include <gtest/gtest.h>

#include "scenarios/scenario.h"

namespace nightjar::scenarios {
namespace {

std::vector<Parameter> table() {
  Scenario scenario;
  ParameterTable visitor;
  scenario.visit(visitor);
  return visitor.parameters();
}

const Parameter& row(const std::vector<Parameter>& rows, const std::string& path) {
  for (const Parameter& each : rows)
    if (each.path == path) return each;
  throw std::out_of_range("no parameter " + path);
}

TEST(ParameterTableTest, ListsEveryKindOfParameterWithItsDefaultAndRange) {
  const auto rows = table();
  EXPECT_EQ(row(rows, "illuminance_lux").default_value, "5");
  EXPECT_EQ(row(rows, "illuminance_lux").allowed, "0.1 to 100000");
  EXPECT_EQ(row(rows, "camera.width_px").default_value, "346");
  EXPECT_EQ(row(rows, "pass.require_landed").allowed, "true, false");
  EXPECT_EQ(row(rows, "world.start_from_tag_m").allowed, "-50 to 50");
  EXPECT_EQ(row(rows, "world.ugv.course").allowed, "2 to 1000 elements");
  EXPECT_EQ(row(rows, "world.ugv.course[].phase").allowed, "straight, turning, landing");
  EXPECT_EQ(row(rows, "name").allowed, "text");
}

TEST(ParameterTableTest, TakesUnitsFromNamesUnlessDeclared) {
  const auto rows = table();
  EXPECT_EQ(row(rows, "illuminance_lux").unit, "lux");
  EXPECT_EQ(row(rows, "world.start_from_tag_m").unit, "m");
  EXPECT_EQ(row(rows, "seed").unit, "");
  EXPECT_EQ(row(rows, "name").unit, "-");
  EXPECT_EQ(row(rows, "sensor.aps.electrons_per_lux_s").unit, "electrons/(lux s)");
  EXPECT_EQ(row(rows, "sensor.aps.gain_fpn").unit, "1");
}

TEST(ParameterTableTest, EverySensorParameterStatesItsUnitAndItsSource) {
  Scenario scenario;
  scenario.sensor.preset = sim::SensorPreset::custom;  // the pixel section, too
  ParameterTable visitor;
  scenario.visit(visitor);
  int parameters = 0;
  for (const Parameter& each : visitor.parameters()) {
    if (!each.path.starts_with("sensor.") && !each.path.starts_with("camera.")) continue;
    ++parameters;
    EXPECT_FALSE(each.unit.empty()) << each.path;
    EXPECT_FALSE(each.source.empty()) << each.path;
  }
  EXPECT_GT(parameters, 35);
}

TEST(ParameterTableTest, AlignsItsColumns) {
  const std::string text = to_text(
      {{"seed", "1", "0 to 9", "", ""}, {"a.long_one_m", "0.25", "0 to 1", "m", "measured"}});
  EXPECT_EQ(text,
            "parameter     default  allowed  unit  source\n"
            "seed          1        0 to 9\n"
            "a.long_one_m  0.25     0 to 1   m     measured\n");
}

}  // namespace
}  // namespace nightjar::scenarios
