#pragma once

#include <cstdint>
#include <string>

#include "core/camera_model.h"
#include "core/state.h"
#include "scenarios/estimates_hash.h"
#include "scenarios/pass_criteria_config.h"
#include "scenarios/picture_record.h"
#include "scenarios/summary.h"
#include "scenarios/tag_config.h"

namespace nightjar::scenarios {

/// Keeps the score of a run: told what happened, it makes the summary.
class Scorer {
 public:
  struct Setup {
    std::string scenario;
    std::uint64_t seed = 0;
    core::CameraModel camera;
    TagConfig tag;  ///< as printed
    PassCriteria criteria;
  };

  explicit Scorer(Setup setup);

  /// Takes one picture, none older than those before. Throws
  /// std::invalid_argument when the record's parts are of different times (an
  /// estimate that is not valid may be of any) or the course's phase is none of
  /// straight, turning, landing.
  void add(const PictureRecord& record);

  /// Takes a step of the mission, before or after the picture it came from.
  void add(const core::MissionTransition& transition);

  void add_events(std::int64_t count) { summary_.events += count; }

  /// The score of a run that ended at `end`. It has landed when the mission has
  /// touched down, the UAV stands on the board in the last picture and has
  /// touched nothing else; the touchdown error is the horizontal distance from
  /// tag centre to UAV body origin in the first picture of both.
  Summary summary(core::Time end, double wall_time_s) const;

 private:
  void check_times(const PictureRecord& record) const;
  PhaseCount& phase_count(const std::string& course_phase);
  void score_landing(const core::Truth& truth);
  void score_estimate(const PictureRecord& record);

  Setup setup_;
  Summary summary_;  ///< what is only counted
  EstimatesHash hash_;
  core::Truth last_;
  std::optional<core::Time> touched_down_;
  std::optional<double> touchdown_error_m_;
  double squared_error_sum_m2_ = 0;
  std::int64_t valid_estimates_ = 0;
};

}  // namespace nightjar::scenarios
