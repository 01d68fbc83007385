#include "scenarios/intrinsics.h"

#include <fmt/format.h>

#include <numbers>

#include "scenarios/intrinsics_config.h"
#include "scenarios/scenario.h"
#include "scenarios/yaml_reader.h"

namespace nightjar::scenarios {

core::CameraModel read_intrinsics(const std::filesystem::path& path) {
  const std::string file = shown_file(path.string());
  IntrinsicsConfig read;
  read_yaml(read_scenario_text(path), file, read);
  try {
    core::check_config(read, "");  // what the file leaves out is 0
  } catch (const std::invalid_argument& error) {
    throw ScenarioError(file + ": " + error.what());
  }
  const core::CameraModel camera{{read.width_px, read.height_px},
                                 read.fx_px,
                                 read.fy_px,
                                 read.cx_px,
                                 read.cy_px,
                                 {read.k1, read.k2, read.p1, read.p2, read.k3}};
  if (!sees_with_all_pixels(camera))
    throw ScenarioError(fmt::format(
        "{}: k1 to k3, p1, p2: this lens turns back within the picture, allowed one that shows "
        "something at every pixel",
        file));
  return camera;
}

IntrinsicsConfig intrinsics_of(const core::CameraModel& camera) {
  const core::Lens& lens = camera.lens;
  return {camera.size.width_px,
          camera.size.height_px,
          camera.fx_px,
          camera.fy_px,
          camera.cx_px,
          camera.cy_px,
          lens.k1,
          lens.k2,
          lens.p1,
          lens.p2,
          lens.k3};
}

bool sees_with_all_pixels(const core::CameraModel& camera) {
  const int right = camera.size.width_px - 1, bottom = camera.size.height_px - 1;
  const auto sees = [&](int x, int y) { return camera.ray({x, y}).allFinite(); };
  for (int x = 0; x <= right; ++x)
    if (!sees(x, 0) || !sees(x, bottom)) return false;
  for (int y = 0; y <= bottom; ++y)
    if (!sees(0, y) || !sees(right, y)) return false;
  return true;
}

core::CameraModel camera_model(const Scenario& scenario) {
  if (!scenario.source.intrinsics.empty()) return read_intrinsics(scenario.source.intrinsics);
  return core::CameraModel::from_fovy({scenario.camera.width_px, scenario.camera.height_px},
                                      scenario.camera.fovy_deg * std::numbers::pi / 180.0);
}

void check_intrinsics(const Scenario& scenario) {
  const std::string& file = scenario.source.intrinsics;
  if (file.empty()) return;
  if (scenario.source.type == camera::SourceType::simulation)
    throw ScenarioError(fmt::format(
        "source.intrinsics = {}, allowed only with source.type = caer: the simulator draws the "
        "ideal pinhole of camera.fovy_deg, without distortion",
        shown_file(file)));
  const core::Resolution size = read_intrinsics(file).size;
  if (size != core::Resolution{scenario.camera.width_px, scenario.camera.height_px})
    throw ScenarioError(
        fmt::format("source.intrinsics = {} is of a camera with {} x {} px, allowed {} x {} "
                    "(camera.width_px, camera.height_px)",
                    shown_file(file), size.width_px, size.height_px, scenario.camera.width_px,
                    scenario.camera.height_px));
}

}  // namespace nightjar::scenarios
