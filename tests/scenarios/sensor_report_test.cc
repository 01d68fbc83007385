#include "scenarios/sensor_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "scenarios/sensor_report_scene.h"
#include "sim/emulator.h"
#include "tests/support/data_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr core::Resolution kSize{100, 80};

SensorReportConfig config_of(sim::SensorPreset preset, double illuminance_lux) {
  SensorReportConfig config;
  config.sensor.preset = preset;
  config.illuminance_lux = illuminance_lux;
  config.size = kSize;
  config.duration_s = 5;
  return config;
}

SensorReport report_on(const SensorReportConfig& config) {
  return report_on_sensor(config, [](double, double, const std::string&) {});
}

/// Shot noise of v2e's law, added up over the pixels that were found quiet.
double shot_events(const SensorReportConfig& config, const PixelActivity& activity) {
  const sim::PixelConfig pixel = effective_pixel(config.sensor, config.illuminance_lux);
  const sim::EventEmulator emulator(pixel, config.size, config.illuminance_lux, config.seed);
  const core::Image<float> bars = grey_bars(config.size, 255);
  double rate_hz = 0;
  for (std::size_t i = 0; i < bars.pixels().size(); ++i) {
    if (activity.kinds.pixels()[i] != PixelKind::quiet) continue;
    const double factor = 1 - 0.75 * (bars.pixels()[i] + 20) / 275;
    rate_hz += pixel.shot_noise_rate_hz / 2 * factor *
               (pixel.threshold_on_log / emulator.thresholds_on_log()[i] +
                pixel.threshold_off_log / emulator.thresholds_off_log()[i]);
  }
  return rate_hz * config.duration_s;
}

/// Leak events of the quiet pixels, if nothing else resets them.
double leak_events(const SensorReportConfig& config, const EventStatistics& figures) {
  const sim::PixelConfig pixel = effective_pixel(config.sensor, config.illuminance_lux);
  const double sigma_ln = std::log(10) * pixel.leak_spread_decades;
  return pixel.leak_rate_hz * std::exp(sigma_ln * sigma_ln / 2) * config.duration_s *
         static_cast<double>(figures.quiet.pixels);
}

// 5 Poisson deviations. Shot noise resets the leak, so that of the leak some part comes.
TEST(SensorReport, a_preset_at_rest_has_the_noise_of_its_parameters) {
  for (const auto& [preset, lux] : {std::pair{sim::SensorPreset::dim, 5.0},
                                    {sim::SensorPreset::bright, 1000.0},
                                    {sim::SensorPreset::by_illuminance, 50.0}}) {
    const SensorReportConfig config = config_of(preset, lux);
    const ReportColumn rest = report_on(config).columns[0];
    const double shot = shot_events(config, rest.activity);
    const double leak = leak_events(config, rest.statistics);
    const auto events = static_cast<double>(rest.statistics.quiet.polarity.events);
    EXPECT_GT(events, shot - 5 * std::sqrt(shot)) << lux;
    EXPECT_LT(events, shot + leak + 5 * std::sqrt(shot + leak)) << lux;
    EXPECT_GT(rest.statistics.quiet.pixels, 0.99 * kSize.pixels()) << lux;
  }
}

// In bright light hardly any shot noise comes in between: the leak's full rate, within 5
// Poisson deviations and what shot noise (a tenth as frequent) may take from it.
TEST(SensorReport, bright_light_leaves_the_leak_which_is_all_on) {
  const SensorReportConfig config = config_of(sim::SensorPreset::bright, 1000);
  const ReportColumn rest = report_on(config).columns[0];
  const double shot = shot_events(config, rest.activity);
  const double leak = leak_events(config, rest.statistics);
  const QuietPixels& quiet = rest.statistics.quiet;
  EXPECT_GT(static_cast<double>(quiet.polarity.events), 0.9 * leak + shot - 5 * std::sqrt(leak));
  EXPECT_GT(*quiet.polarity.on_share, 0.9);
}

TEST(SensorReport, a_clean_sensor_at_rest_says_nothing) {
  const SensorReport report = report_on(config_of(sim::SensorPreset::clean, 1000));
  EXPECT_EQ(report.columns[0].statistics.all.events, 0u);
  EXPECT_EQ(report.columns[1].statistics.quiet.polarity.events, 0u);
}

// Quiet means the same before a scene at rest and beside a moving one.
TEST(SensorReport, the_quiet_pixels_beside_the_moving_texture_are_as_those_at_rest) {
  const SensorReport report = report_on(config_of(sim::SensorPreset::dim, 5));
  const QuietPixels& rest = report.columns[0].statistics.quiet;
  const QuietPixels& moving = report.columns[1].statistics.quiet;
  // 40 of 80 rows move, and up to 4 on either side are too close.
  EXPECT_GT(moving.pixels, 0.98 * 32 * 100);
  EXPECT_LE(moving.pixels, 40 * 100);
  EXPECT_NEAR(*moving.rate_hz, *rest.rate_hz,
              5 * std::hypot(*rest.rate_error_hz, *moving.rate_error_hz));
}

// A texture that goes by comes back to each value: without noise and with equal mean
// thresholds, as many steps up as down, but for those under way at either end (2 s,
// 100 px/s, up to 64 px a wave: at most some 10 % of a pixel's).
TEST(SensorReport, a_texture_that_moves_gives_as_many_on_as_off_events) {
  const SensorReport report = report_on(config_of(sim::SensorPreset::clean, 1000));
  const EventStatistics& moving = report.columns[1].statistics;
  EXPECT_NEAR(*moving.signal.on_share, 0.5, 0.03);
  EXPECT_GT(moving.signal.events, 10000u);
}

TEST(SensorReport, twice_the_speed_halves_the_intervals) {
  SensorReportConfig config = config_of(sim::SensorPreset::clean, 1000);
  config.duration_s = 10;
  config.speed_px_s = 50;
  const auto slow = report_on(config).columns[1].statistics.intervals.quantiles_us[3];
  config.speed_px_s = 100;
  config.duration_s = 5;  // the same way
  const auto fast = report_on(config).columns[1].statistics.intervals.quantiles_us[3];
  // The same crossings; microseconds are rounded and rows of events wait for the readout.
  EXPECT_NEAR(static_cast<double>(*slow) / static_cast<double>(*fast), 2, 0.02);
}

TEST(SensorReport, the_same_seed_gives_the_same_events_and_another_seed_others) {
  SensorReportConfig config = config_of(sim::SensorPreset::dim, 5);
  config.duration_s = 1;
  const SensorReport one = report_on(config), same = report_on(config);
  config.seed = 2;
  const SensorReport other = report_on(config);
  for (std::size_t i : {0, 1}) {
    EXPECT_EQ(one.columns[i].activity.events, same.columns[i].activity.events);
    EXPECT_NE(one.columns[i].activity.events, other.columns[i].activity.events);
  }
}

TEST(SensorReport, progress_goes_from_the_start_to_the_end) {
  SensorReportConfig config = config_of(sim::SensorPreset::clean, 5);
  config.duration_s = 1;
  double last_s = -1, whole_s = 0;
  report_on_sensor(config, [&](double done_s, double end_s, const std::string&) {
    EXPECT_GE(done_s, last_s);
    last_s = done_s;
    whole_s = end_s;
  });
  EXPECT_NEAR(last_s, whole_s, 1e-9);
}

// At 10 px/s a quarter of a pixel takes 25 ms, a fifth of 0.1 s is 20 ms.
TEST(SensorReport, the_shortest_report_has_two_pictures_even_of_the_slowest_texture) {
  SensorReportConfig config = config_of(sim::SensorPreset::dim, 5);
  config.duration_s = 0.1;
  config.speed_px_s = 10;
  const auto within = [](double done_s, double end_s, const std::string&) {
    EXPECT_LE(done_s, end_s);
  };
  const SensorReport report = report_on_sensor(config, within);
  EXPECT_DOUBLE_EQ(report.columns[0].statistics.duration_s, 0.1);
  EXPECT_DOUBLE_EQ(report.columns[1].statistics.duration_s, 0.025);
}

// When one is lost ten wait, and the last of them waits for the others' 1 ms each.
TEST(SensorReport, a_slow_readout_shows_in_what_is_lost_and_in_the_delay) {
  SensorReportConfig config = config_of(sim::SensorPreset::dim, 5);
  config.duration_s = 1;
  EXPECT_EQ(report_on(config).columns[0].lost_events, 0u);
  EXPECT_LT(*report_on(config).columns[0].max_delay, 1ms);
  config.sensor.readout.max_event_rate_hz = 1000;
  config.sensor.readout.queue_capacity_events = 10;
  const ReportColumn moving = report_on(config).columns[1];
  EXPECT_GT(*moving.lost_events, 100u);
  EXPECT_GE(*moving.max_delay, 9ms);
}

TEST(SensorReport, what_is_out_of_range_is_refused) {
  const auto refused = [](auto change, const char* name) {
    SensorReportConfig config;
    change(config);
    EXPECT_THAT([&] { report_on(config); }, ThrowsMessage<std::invalid_argument>(HasSubstr(name)));
  };
  refused([](auto& c) { c.illuminance_lux = 0; }, "illuminance_lux = 0");
  refused([](auto& c) { c.illuminance_lux = std::numeric_limits<double>::quiet_NaN(); },
          "illuminance_lux");
  refused([](auto& c) { c.size = {15, 260}; }, "size.width_px = 15");
  refused([](auto& c) { c.size = {346, 4000}; }, "size.height_px = 4000");
  refused([](auto& c) { c.duration_s = 0; }, "duration_s = 0");
  refused([](auto& c) { c.speed_px_s = 5; }, "speed_px_s = 5");
  refused([](auto& c) { c.sensor.readout.max_event_rate_hz = 0; }, "max_event_rate_hz");
}

TEST(SensorReport, a_recording_lasts_from_its_first_event_to_its_last) {
  const camera::EventRecording recording{{20, 10},
                                         {{5s, 1, 1, true}, {6s, 2, 2, false}, {9s, 3, 3, true}}};
  const ReportColumn column = report_on_recording("three.txt", recording);
  EXPECT_EQ(column.name, "three.txt");
  EXPECT_DOUBLE_EQ(column.statistics.duration_s, 4);
  EXPECT_EQ(column.statistics.all.events, 3u);
  EXPECT_EQ(column.lost_events, std::nullopt);
  EXPECT_EQ(column.max_delay, std::nullopt);
}

TEST(SensorReport, a_recording_without_events_or_time_is_refused) {
  const auto refused = [](std::vector<core::Event> events) {
    const camera::EventRecording recording{{20, 10}, std::move(events)};
    EXPECT_THAT([&] { report_on_recording("few.txt", recording); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("few.txt: ")));
  };
  refused({});
  refused({{5s, 1, 1, true}});
  refused({{5s, 1, 1, true}, {5s, 2, 1, true}});
}

// Counted by other means (awk) over the file.
TEST(SensorReport, a_real_recording_has_its_known_figures) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no recordings here";
  const auto recording =
      camera::read_event_text(*folder / "davis240c_slider_depth.txt", core::Resolution{240, 180});
  const EventStatistics figures = report_on_recording("slider", recording).statistics;
  EXPECT_EQ(figures.all.events, 50000u);
  EXPECT_DOUBLE_EQ(*figures.all.on_share, 21147.0 / 50000);
  EXPECT_NEAR(figures.duration_s, 0.170345, 1e-6);
  EXPECT_EQ(figures.hot.pixels.size(), 0u);
}

}  // namespace
}  // namespace nightjar::scenarios
