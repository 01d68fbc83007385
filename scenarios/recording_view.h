#pragma once

#include <functional>
#include <string>

#include "camera/recording.h"

namespace nightjar::scenarios {

struct RecordingViewOptions {
  double at_s = 0;                                ///< After the first event.
  double span_s = 0.01;                           ///< How long events are gathered from then on.
  std::function<void(double share)> on_progress;  ///< Of the file; may throw to stop.
};

struct RecordingView {
  std::string png;           ///< The file's bytes.
  std::uint64_t events = 0;  ///< That are shown.
  bool has_frame = false;
};

/// Draws the events of [at, at + span): ON green, OFF red, the later one where a pixel has
/// several, on the last frame exposed by the end of it, and that frame beside it at the
/// brightness it has; where there is no frame yet, on grey alone. Reads no further than it
/// has to. Throws std::invalid_argument for options out of range (at 0 to 1e9 s, span 1e-6
/// to 1e6 s), a sensor over 4096 a side, a recording without events, and one that ends before `at`.
RecordingView draw_recording(camera::RecordingReader& recording,
                             const RecordingViewOptions& options);

}  // namespace nightjar::scenarios
