#include "scenarios/sensor_report_plot.h"

#include <gtest/gtest.h>

#include "scenarios/gnuplot.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

/// A big-endian number of a PNG's header.
int header_number(const std::string& png, std::size_t at) {
  int number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number = number * 256 + static_cast<unsigned char>(png[at + i]);
  return number;
}

void expect_picture(const SensorReport& report) {
  const std::string png = draw_png(report);
  ASSERT_GT(png.size(), 10000u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(header_number(png, 16), 1800);
  EXPECT_EQ(header_number(png, 20), 1080);
  EXPECT_NE(png.find("IEND"), std::string::npos);
}

TEST(SensorReportPlot, draws_simulation_and_recording_in_one_picture) {
  SensorReportConfig config;
  config.size = {40, 30};
  config.duration_s = 0.5;
  SensorReport report = report_on_sensor(config, [](double, double, const std::string&) {});
  const camera::EventRecording recording{{20, 10}, {{5s, 1, 1, true}, {6s, 1, 1, false}}};
  report.columns.push_back(report_on_recording("it's `odd`\n.txt", recording));
  expect_picture(report);
}

TEST(SensorReportPlot, draws_a_sensor_without_events) {
  SensorReportConfig config;
  config.sensor.preset = sim::SensorPreset::clean;
  config.size = {40, 30};
  config.duration_s = 0.5;
  expect_picture(report_on_sensor(config, [](double, double, const std::string&) {}));
}

}  // namespace
}  // namespace nightjar::scenarios
