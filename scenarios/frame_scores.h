#pragma once

#include "camera/recording.h"
#include "scenarios/method_scores.h"
#include "scenarios/score_options.h"

namespace nightjar::scenarios {

/// Compares, at the middle of each chosen frame's exposure, the picture that each method has
/// made of the events up to then (and, where it uses them, of the frames whose exposure had
/// ended) with that frame. All methods go through the recording together and are compared
/// with the same frames. `events` and `frames` are one recording opened twice, for a file may
/// hold a frame behind events that came after it; in memory is a part of each.
///
/// A recurrent network takes its steps 1/rate_hz apart as nearly as lets one of them end at
/// the middle of every frame: see NetworkSteps. Skipped are networks without weights, and EDI
/// and FEDI where no frame they could use had ended by the last comparison; had one by then,
/// their means hold the comparisons before it, too.
///
/// Throws std::invalid_argument for options out of range and for what the readers and the
/// reconstructors throw it for; EmptyRecording for one without events or frames to compare, and
/// before it reads anything for a sensor with a side under kLeastSide_px.
MethodScores score_frames(camera::RecordingReader& events, camera::RecordingReader& frames,
                          const ScoreOptions& options, const FrameChoice& choice);

}  // namespace nightjar::scenarios
