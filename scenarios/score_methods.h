#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "core/image.h"
#include "esi/config.h"
#include "scenarios/method_scores.h"

namespace nightjar::scenarios {

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

/// Compares each method's picture at the end of the recording, or at options.until_s, with
/// `reference`, whose size the recording has to have. A network without weights is skipped,
/// and so is a method that starts from frames where the recording holds none: the reference
/// would be its own input. Throws std::invalid_argument as reconstruct() does.
MethodScores score_against_picture(const std::filesystem::path& recording,
                                   const core::Image<std::uint8_t>& reference,
                                   const ScoreOptions& options);

/// Compares each method's pictures with the recording's frames: score_frames(). `size` as
/// open_recording() takes it. Throws std::invalid_argument, naming the file.
MethodScores score_against_frames(const std::filesystem::path& recording,
                                  std::optional<core::Resolution> size, const ScoreOptions& options,
                                  const FrameChoice& choice);

}  // namespace nightjar::scenarios
