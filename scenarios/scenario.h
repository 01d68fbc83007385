#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "camera/config.h"
#include "esi/config.h"
#include "scenarios/pass_criteria_config.h"
#include "scenarios/scenario_error.h"
#include "scenarios/tag_config.h"
#include "sim/config.h"
#include "sim/sensor_config.h"
#include "tracker/config.h"

namespace nightjar::scenarios {

/// Everything a run depends on. The same scenario, seed and build give the same
/// estimates, bit for bit.
struct Scenario {
  std::string name = "unnamed";
  int seed = 1;                  ///< Of every random stream.
  double duration_s = 62.0;      ///< The run ends here at the latest.
  double illuminance_lux = 5.0;  ///< On the ground.
  /// The MJCF scene that the simulator flies in. In a file: relative to that file. In the
  /// struct, after load(): relative to the working directory.
  std::string model;
  nightjar::camera::SourceConfig source;
  sim::WorldConfig world;
  TagConfig tag;
  sim::CameraConfig camera;
  sim::SensorConfig sensor;
  esi::ReconstructorConfig reconstructor;
  tracker::TrackerConfig tracker;
  PassCriteria pass;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("name", name);
    v.field("seed", seed, 0, std::numeric_limits<int>::max());
    v.field("duration_s", duration_s, 0.01, 3600.0);
    v.field("illuminance_lux", illuminance_lux, 0.1, 100000.0);
    v.field("model", model);
    v.section("source", source);
    v.section("world", world);
    v.section("tag", tag);
    v.section("camera", camera);
    v.section("sensor", sensor);
    v.section("reconstructor", reconstructor);
    v.section("tracker", tracker);
    v.section("pass", pass);
  }
};

/// Reads and checks a scenario file. What it does not say keeps its default, save that
/// tracker.measurement.corner_inset_px goes by the method (corner_inset.h). Throws
/// ScenarioError, whose text starts with the file's name, for everything that is wrong with
/// it, a missing model among them.
Scenario load(const std::filesystem::path& path);

/// As load(), from `text` that stands in (or would stand in) the file `path`.
Scenario parse(const std::string& text, const std::filesystem::path& path);

/// Throws ScenarioError unless every value is in range, all fit each other
/// (check_consistency, check_intrinsics, check_mount) and the simulator's model exists.
void check(const Scenario& scenario);

/// Writes every value, with its range as a comment, so that load(path) gives the
/// same scenario; the pixels that a preset stands for follow as a comment. Throws
/// ScenarioError when the file cannot be written.
void save(const Scenario& scenario, const std::filesystem::path& path);

}  // namespace nightjar::scenarios
