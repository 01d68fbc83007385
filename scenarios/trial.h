#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "esi/config.h"
#include "scenarios/tag_config.h"
#include "sim/carried_path.h"
#include "sim/config.h"
#include "tracker/config.h"

namespace nightjar::scenarios {

/// A reconstruction method as it takes part.
struct TrialEntry {
  std::string name;
  esi::ReconstructorConfig config;
};

/// Which sequences the methods are tried on: a camera carried over the scene's tag
/// (sim::CarriedCamera), for every motion, light and seed.
struct TrialConfig {
  std::filesystem::path model;
  std::vector<sim::CarryMotion> motions = {sim::CarryMotion::hover, sim::CarryMotion::slow,
                                           sim::CarryMotion::fast, sim::CarryMotion::shake};
  std::vector<double> illuminances_lux = {2, 5, 10, 1000};
  std::vector<std::uint64_t> seeds = {1};
  double duration_s = 4.0;  ///< Of each sequence, 1.1 to 600; scored from 1 s on.
  int score_every = 4;      ///< Of the pictures, which come with every packet.
  sim::CameraConfig camera;
  sim::SensorConfig sensor;
  sim::RendererConfig renderer;
  tracker::DetectorConfig detector;
  TagConfig tag;
};

/// What one method made of one sequence.
struct TrialScore {
  std::string method;
  sim::CarryMotion motion = sim::CarryMotion::hover;
  double illuminance_lux = 0;
  std::uint64_t seed = 0;
  int visible = 0;   ///< Scored pictures with the whole tag 12 px or more inside the rim.
  int detected = 0;  ///< Of them, those with the tag decoded, every corner within 5 px.
  int false_detections = 0;
  int compared = 0;     ///< Pictures compared with what the camera saw.
  double ssim_sum = 0;  ///< Over them: esi::compare() with the sharp, noiseless picture.
};

/// What a row of many scores has in common.
struct TrialCell {
  double detection_rate = 0;  ///< Detected of visible, all seeds together; 0 without any.
  double ssim = 0;            ///< Mean.
  int false_detections = 0;
};

/// Those of `scores` of one method, motion and light, together.
TrialCell trial_cell(const std::vector<TrialScore>& scores, const std::string& method,
                     sim::CarryMotion motion, double illuminance_lux);

/// Called before each sequence: how many are done, of how many, and its name.
using TrialProgress = std::function<void(int done, int all, const std::string& sequence)>;

/// Flies every sequence once, past all entries. Throws std::invalid_argument for a bad
/// config or an entry that cannot be built.
std::vector<TrialScore> run_trial(const TrialConfig& config, const std::vector<TrialEntry>& entries,
                                  const TrialProgress& progress);

}  // namespace nightjar::scenarios
