#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/stage_timer.h"
#include "core/state.h"

namespace nightjar::scenarios {

struct PhaseCount {
  std::int64_t pictures = 0;
  std::int64_t detections = 0;
};

/// What a run came to. Members are named as in summary.json.
struct Summary {
  std::string scenario;
  std::uint64_t seed = 0;
  double sim_time_s = 0;
  double wall_time_s = 0;
  double real_time_factor = 0;  ///< simulated seconds a second of wall time

  std::int64_t pictures = 0;
  std::int64_t detections = 0;        ///< pictures whose tag was found where it is
  double detection_rate = 0;          ///< detections / pictures, 0 without pictures
  std::int64_t false_detections = 0;  ///< every other tag decoded
  PhaseCount straight;                ///< by the phase of the UGV's course
  PhaseCount turning;
  PhaseCount landing;

  std::int64_t events = 0;
  std::int64_t events_lost = 0;
  double event_rate_hz = 0;
  std::int64_t max_readout_delay_us = 0;  ///< from a pixel's request to its readout
  std::int64_t bad_radiance = 0;          ///< pixel values corrected: negative, not finite

  std::int64_t renders = 0;
  std::int64_t renders_late = 0;  ///< farther apart than renderer.max_motion_px asks

  bool landed = false;
  bool crashed = false;
  bool ugv_collided = false;
  std::optional<double> touchdown_error_m;         ///< nothing when not landed
  std::optional<double> relative_position_rmse_m;  ///< nothing without a valid estimate
  std::vector<core::MissionTransition> transitions;
  std::string estimates_sha256;

  bool passed = false;
  std::vector<std::string> failed_criteria;

  std::vector<core::StageTime> profile;  ///< What the loop's stages took.
};

/// The summary as indented JSON, one object, ending in a line break; "nothing" is null.
std::string to_json(const Summary& summary);

/// The summary as lines of text for a terminal, without the profile.
std::string to_table(const Summary& summary);

/// The profile alone, by thread.
std::string profile_table(const Summary& summary);

}  // namespace nightjar::scenarios
