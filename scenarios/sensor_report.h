#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "camera/event_text.h"
#include "core/event.h"
#include "scenarios/event_statistics.h"
#include "scenarios/pixel_activity.h"
#include "sim/sensor_config.h"

namespace nightjar::scenarios {

/// Which sensor to report on, and for how long.
struct SensorReportConfig {
  sim::SensorConfig sensor;
  double illuminance_lux = 5.0;
  core::Resolution size{346, 260};
  std::uint64_t seed = 1;
  /// Of the scene at rest, 0.1 to 60. The moving one lasts a fifth of it, or as long as
  /// its first two pictures take.
  double duration_s = 10.0;
  double speed_px_s = 100.0;  ///< Of the moving texture; 10 to 2000.
};

/// One column of the report.
struct ReportColumn {
  std::string name;
  PixelActivity activity;
  EventStatistics statistics;
  std::optional<std::uint64_t> lost_events = {};  ///< In the readout; unknown for a recording.
  std::optional<core::Time> max_delay = {};       ///< An event's longest wait there; likewise.
};

struct SensorReport {
  SensorReportConfig config;
  std::vector<ReportColumn> columns;
};

/// Told how many simulated seconds of how many are done, and of what.
using ReportProgress = std::function<void(double done_s, double end_s, const std::string& phase)>;

/// The simulated sensor, whole (pixels, readout, noise filter): before the grey bars at
/// rest, then before the moving pattern (sensor_report_scene.h).
/// Throws std::invalid_argument for a config out of range.
SensorReport report_on_sensor(const SensorReportConfig& config, const ReportProgress& progress);

/// The column of a recording, from its first event to its last.
/// Throws std::invalid_argument, with `name`, unless that is some time.
ReportColumn report_on_recording(const std::string& name, const camera::EventRecording& recording);

}  // namespace nightjar::scenarios
