#pragma once

#include <string>
#include <vector>

#include "scenarios/calibration.h"

namespace nightjar::scenarios {

/// A calibration and what it came from.
struct CalibrationReport {
  std::string source;          ///< The recording or folder, for people.
  std::uint64_t pictures = 0;  ///< Looked at,
  std::uint64_t boards = 0;    ///< with a board in them,
  Calibration calibration;     ///< and what those of them gave that differ most.
};

/// The file that read_intrinsics() reads, with standard deviations as comments. Throws
/// std::invalid_argument, naming it, for a number that it would not allow.
std::string to_intrinsics_yaml(const CalibrationReport& report);

/// For people and for scripts.
std::string to_table(const CalibrationReport& report);
std::string to_json(const CalibrationReport& report);

/// What to do better, one line each; empty when the views suffice: corners in less than 80 %
/// of the picture's cells, a focal length known worse than 1 %, an rms over 1 px, or more than
/// a fifth of the views left out.
std::vector<std::string> advice(const CalibrationReport& report);

}  // namespace nightjar::scenarios
