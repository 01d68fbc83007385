#include "scenarios/sensor_report_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// One column of a 20x10 px sensor over 4 s, and one without events.
SensorReport small_report() {
  SensorReport report;
  report.config.sensor.preset = sim::SensorPreset::dim;
  const camera::EventRecording recording{
      {20, 10}, {{5s, 1, 1, true}, {6s, 1, 1, false}, {6500ms, 7, 7, true}, {9s, 1, 1, false}}};
  report.columns.push_back(report_on_recording("four events", recording));
  ReportColumn silent{"silence", pixel_activity({}, {20, 10}, 0s, 1s), {}, 12, 1234us};
  silent.statistics = event_statistics(silent.activity);
  report.columns.push_back(silent);
  return report;
}

TEST(SensorReportText, the_table_names_each_column_once_and_aligns_them) {
  const std::string table = to_table(small_report());
  EXPECT_THAT(table, HasSubstr("preset dim, 5 lux, seed 1"));
  EXPECT_THAT(table, HasSubstr("             four events                 silence\n"));
  EXPECT_THAT(
      table,
      HasSubstr("events                                             4                       0\n"));
  EXPECT_THAT(
      table,
      HasSubstr("  lost in the readout                              -                      12\n"));
  EXPECT_THAT(
      table,
      HasSubstr("  greatest delay there                             -                1.234 ms\n"));
  EXPECT_THAT(
      table,
      HasSubstr("interval, shortest                       1000.000 ms                       -\n"));
}

TEST(SensorReportText, json_holds_the_figures_and_null_for_what_does_not_exist) {
  const auto json = nlohmann::json::parse(to_json(small_report()));
  EXPECT_EQ(json["preset"], "dim");
  const auto& four = json["columns"][0];
  EXPECT_EQ(four["name"], "four events");
  EXPECT_EQ(four["width_px"], 20);
  EXPECT_EQ(four["duration_s"], 4.0);
  EXPECT_EQ(four["all"]["on_share"], 0.5);
  EXPECT_EQ(four["lost_events"], nullptr);
  EXPECT_EQ(four["max_delay_us"], nullptr);
  EXPECT_EQ(four["intervals"]["quantiles"][3]["share"], 0.5);
  EXPECT_EQ(four["intervals"]["quantiles"][3]["interval_us"], 1000000);
  const auto& silence = json["columns"][1];
  EXPECT_EQ(silence["all"]["on_share"], nullptr);
  EXPECT_EQ(silence["quiet"]["pixels"], 200);
  EXPECT_EQ(silence["lost_events"], 12);
  EXPECT_EQ(silence["max_delay_us"], 1234);
}

TEST(SensorReportText, a_name_that_is_no_utf8_still_gives_json) {
  SensorReport report = small_report();
  report.columns[0].name = "\xff.txt";
  EXPECT_NO_THROW(nlohmann::json::parse(to_json(report)));
}

}  // namespace
}  // namespace nightjar::scenarios
