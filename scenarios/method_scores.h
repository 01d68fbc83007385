#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "esi/quality.h"

namespace nightjar::scenarios {

/// Of a picture that can be scored: esi::compare()'s window has to fit.
inline constexpr int kLeastSide_px = 11;

/// "8x8 px, allowed from 11x11 px" for pictures too small to be scored, else empty.
std::string too_small(core::Resolution size);

/// How like a reference a picture is.
struct Score {
  esi::Quality quality;
  double explained = 0;  ///< Share of the reference's variance, 1 - mse / variance: 0 to 1.
};

/// esi::compare() and the share explained, which is 0 where the reference has no variance.
/// Throws as esi::compare().
Score score(const core::Image<std::uint8_t>& picture, const core::Image<std::uint8_t>& reference);

/// Mean squared difference from the mean, grey levels squared.
double variance(const core::Image<std::uint8_t>& picture);

/// A score against one frame of the recording.
struct FrameScore {
  core::Time t{};  ///< The middle of its exposure, the recording's own time.
  Score score;
};

/// How like its references the pictures are that one method makes of a recording.
struct MethodScore {
  std::string method;
  bool saw_frames = false;         ///< Made its pictures of frames, too.
  std::optional<Score> score;      ///< Of several frames the mean of each number.
  std::vector<FrameScore> frames;  ///< Empty where a picture was the reference.
  std::string skipped;             ///< Why there is no score.
};

/// How many of a recording's frames were references, and why others were not. Frames after
/// ScoreOptions::until_s are not counted.
struct FrameCount {
  std::uint64_t compared = 0;
  std::uint64_t too_early = 0;
  std::uint64_t after_events = 0;  ///< No event came after the middle of the exposure.
  std::uint64_t exposed_too_long = 0;
  std::uint64_t unfit = 0;  ///< Of a part of the sensor, or of one grey level.
};

/// What came of comparing several methods with the same references.
struct MethodScores {
  std::vector<MethodScore> methods;
  std::optional<FrameCount> frames;  ///< Where those were the references.
  std::string first_fault;           ///< Of the recording, else empty.
};

/// The mean of each number; empty of no frames.
std::optional<Score> mean_score(const std::vector<FrameScore>& frames);

/// "12 frames compared, 3 left out: 1 too early, 2 exposed for too long".
std::string to_text(const FrameCount& count);

/// For people and for scripts.
std::string to_table(const MethodScores& scores);
std::string to_json(const MethodScores& scores);

}  // namespace nightjar::scenarios
