#pragma once

#include <filesystem>
#include <optional>

#include "core/image.h"
#include "scenarios/method_scores.h"
#include "scenarios/score_options.h"

namespace nightjar::scenarios {

/// Compares each method's picture at the end of the recording, or at options.until_s, with
/// `reference`, whose size the recording has to have. A network without weights is skipped,
/// and so is a method that starts from frames where the recording holds none: the reference
/// would be its own input. Throws std::invalid_argument as open_recording() and reconstruct()
/// do, and before it reads anything for a reference with a side under kLeastSide_px.
MethodScores score_against_picture(const std::filesystem::path& recording,
                                   const core::Image<std::uint8_t>& reference,
                                   const ScoreOptions& options);

/// Compares each method's pictures with the recording's frames: score_frames(). `size` as
/// open_recording() takes it. Throws as those two; where the recording has nothing to compare,
/// the message names the file.
MethodScores score_against_frames(const std::filesystem::path& recording,
                                  std::optional<core::Resolution> size, const ScoreOptions& options,
                                  const FrameChoice& choice);

}  // namespace nightjar::scenarios
