#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "esi/config.h"

namespace nightjar::scenarios {

/// Which methods are compared with references, with which parameters, and how far into the
/// recording.
struct ScoreOptions {
  esi::ReconstructorConfig reconstructor;  ///< Its method does not matter.
  std::vector<esi::Method> methods;
  double rate_hz = 100;           ///< Of pictures, 0.01 to 100000: how networks advance.
  std::optional<double> until_s;  ///< After the first event; by default to the last.
  /// Called with the share that is done. May throw to stop.
  std::function<void(double share)> on_progress = [](double) {};
};

/// Which of a recording's frames are references.
struct FrameChoice {
  double from_s = 0.05;         ///< Least time from the first event to an exposure's middle.
  double max_exposure_ms = 50;  ///< What moves is blurred in frames exposed for longer.
};

}  // namespace nightjar::scenarios
