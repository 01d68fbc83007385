#pragma once

#include <vector>

#include "core/state.h"
#include "core/truth.h"

namespace nightjar::scenarios {

/// What was, what was seen and what was believed at the time of one picture.
struct PictureRecord {
  core::Truth truth;
  core::VehicleState vehicle;  ///< as the autopilot estimates it
  core::TargetEstimate estimate;
  std::vector<core::TagDetection> detections;  ///< all that were decoded
  core::MissionPhase mission_phase{};
};

}  // namespace nightjar::scenarios
