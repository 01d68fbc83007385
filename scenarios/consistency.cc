#include "scenarios/consistency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/caer_camera.h"
#include "core/event.h"
#include "scenarios/scenario.h"
#include "sim/aps.h"

namespace nightjar::scenarios {
namespace {

using core::number_text;

void check_course(const std::vector<sim::Waypoint>& course) {
  for (std::size_t i = 1; i < course.size(); ++i)
    if (std::hypot(course[i].x_m - course[i - 1].x_m, course[i].y_m - course[i - 1].y_m) < 1e-3)
      throw ScenarioError(fmt::format(
          "world.ugv.course[{}] lies on its predecessor, allowed at least 0.001 m apart", i));
}

// An exposure longer than the interval puts the next one off.
void check_frames(const sim::ApsConfig& aps, double illuminance_lux, double max_interval_ms) {
  const double exposure_ms = 1e3 * core::seconds(sim::aps_exposure(aps, illuminance_lux));
  if (std::max(exposure_ms, aps.interval_ms) >= max_interval_ms) return;
  throw ScenarioError(fmt::format(
      "sensor.aps.interval_ms = {} with an exposure of {} ms (sensor.aps.exposure_ms), "
      "allowed one of them at least world.renderer.max_interval_ms = {}",
      number_text(aps.interval_ms), number_text(exposure_ms), number_text(max_interval_ms)));
}

void check_pixel(const sim::SensorConfig& sensor) {
  const double knee = sensor.pixel.log_linear_below;
  if (sensor.preset == sim::SensorPreset::custom && knee > 0 && knee < std::numbers::e)
    throw ScenarioError(fmt::format("sensor.pixel.log_linear_below = {}, allowed 0, or 2.72 to 128",
                                    number_text(knee)));
}

// A real camera has its own size, whatever the scenario makes of it.
void check_size(const sim::CameraConfig& camera, nightjar::camera::SourceType source) {
  constexpr core::Resolution kReal = nightjar::camera::CaerCamera::kSize;
  if (source != nightjar::camera::SourceType::caer ||
      (camera.width_px == kReal.width_px && camera.height_px == kReal.height_px))
    return;
  throw ScenarioError(fmt::format(
      "camera.width_px = {}, camera.height_px = {}, allowed {} and {} with source.type = caer",
      camera.width_px, camera.height_px, kReal.width_px, kReal.height_px));
}

}  // namespace

void check_consistency(const Scenario& scenario) {
  check_course(scenario.world.ugv.course);
  check_frames(scenario.sensor.aps, scenario.illuminance_lux,
               scenario.world.renderer.max_interval_ms);
  check_pixel(scenario.sensor);
  check_size(scenario.camera, scenario.source.type);
}

}  // namespace nightjar::scenarios
