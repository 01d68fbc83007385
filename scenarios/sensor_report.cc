#include "scenarios/sensor_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/config_check.h"
#include "scenarios/sensor_report_scene.h"
#include "sim/simulated_camera.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kRestInterval = 10ms;  // still scenes need no shorter steps
constexpr double kMovingShare = 0.2;

void check(const SensorReportConfig& config) {
  core::check_config(config.sensor, "sensor");
  core::check_range("illuminance_lux", config.illuminance_lux, 0.1, 100000);
  core::check_range("size.width_px", config.size.width_px, 16, 2048);
  core::check_range("size.height_px", config.size.height_px, 16, 2048);
  core::check_range("duration_s", config.duration_s, 0.1, 60);
  core::check_range("speed_px_s", config.speed_px_s, 10, 2000);
}

/// Shows a camera one picture after the other and keeps all events.
class Exposure {
 public:
  explicit Exposure(const SensorReportConfig& config)
      : camera_(without_frames(config.sensor), config.size, config.illuminance_lux, config.seed) {}

  void show(core::Time t, const core::Image<float>& luminance_lux) {
    camera_.expose(t, luminance_lux);
    const core::EventPacket packet = camera_.take(t).packet;
    events_.insert(events_.end(), packet.events.begin(), packet.events.end());
    end_ = t;
  }

  ReportColumn column(const std::string& name, core::Resolution size) const {
    ReportColumn column{name, pixel_activity(events_, size, core::Time(0), end_), {}};
    column.statistics = event_statistics(column.activity);
    column.lost_events = camera_.readout_counts().lost;
    column.max_delay = camera_.readout_counts().max_delay;
    return column;
  }

 private:
  /// The active pixels do not matter here, and their defaults allow our steps.
  static sim::SensorConfig without_frames(sim::SensorConfig sensor) {
    sensor.aps = {};
    return sensor;
  }

  sim::SimulatedCamera camera_;
  std::vector<core::Event> events_;
  core::Time end_{};
};

ReportColumn at_rest(const SensorReportConfig& config, const ReportProgress& progress) {
  Exposure exposure(config);
  const core::Image<float> bars = grey_bars(config.size, config.illuminance_lux);
  const core::Time end = core::from_seconds(config.duration_s);
  for (core::Time t{}; t <= end; t += kRestInterval) {
    exposure.show(t, bars);
    progress(core::seconds(t), config.duration_s * (1 + kMovingShare), "at rest");
  }
  return exposure.column("at rest", config.size);
}

ReportColumn moving(const SensorReportConfig& config, const ReportProgress& progress) {
  Exposure exposure(config);
  MovingPattern pattern(config.size, config.illuminance_lux, config.speed_px_s,
                        config.duration_s * kMovingShare, config.seed);
  const double end_s = config.duration_s * (1 + kMovingShare);
  for (int i = 0; i < pattern.pictures(); ++i) {
    const core::Time t = i * pattern.interval();
    exposure.show(t, pattern.draw(i));
    progress(std::min(config.duration_s + core::seconds(t), end_s), end_s, "moving");
  }
  return exposure.column("moving", config.size);
}

}  // namespace

SensorReport report_on_sensor(const SensorReportConfig& config, const ReportProgress& progress) {
  check(config);
  SensorReport report{config, {}};
  report.columns.push_back(at_rest(config, progress));
  report.columns.push_back(moving(config, progress));
  return report;
}

ReportColumn report_on_recording(const std::string& name, const camera::EventRecording& recording) {
  const std::vector<core::Event>& events = recording.events;
  if (events.empty() || events.front().t == events.back().t)
    throw std::invalid_argument(fmt::format(
        "{}: {} events, expected two at least, at different times", name, events.size()));
  ReportColumn column{
      name, pixel_activity(events, recording.size, events.front().t, events.back().t), {}};
  column.statistics = event_statistics(column.activity);
  return column;
}

}  // namespace nightjar::scenarios
