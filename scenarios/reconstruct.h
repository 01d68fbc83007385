#pragma once

#include <functional>
#include <optional>
#include <span>
#include <stdexcept>

#include "camera/recording.h"
#include "core/image.h"
#include "core/state.h"
#include "esi/config.h"
#include "scenarios/reconstruction.h"
#include "tracker/config.h"

namespace nightjar::scenarios {

/// Thrown for a recording in which there is nothing of what was asked for. The message does not
/// name it: whoever opened it knows its name.
class EmptyRecording : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Of from_s and until_s.
inline constexpr double kMostSeconds = 1e9;

struct ReconstructOptions {
  esi::ReconstructorConfig reconstructor;
  double rate_hz = 100;                             ///< Of the pictures, 0.01 to 100000.
  std::optional<tracker::DetectorConfig> detector;  ///< Looks for tags in all of each picture.
  std::optional<double> from_s;   ///< After the first event; earlier are left out.
  std::optional<double> until_s;  ///< After the first event.
  /// Called after every picture and part of the recording: seconds done, of how many (an
  /// estimate). May throw to stop.
  std::function<void(double done_s, double end_s)> on_progress;
};

/// Called for every picture with the tags in it (none when not searched).
using TakePicture = std::function<void(const core::Picture&, std::span<const core::TagDetection>)>;

/// Makes a picture of the recording's events every 1/rate_hz, the first that long after the
/// first event, the last no later than the last one. Methods that use frames get those of
/// the recording as they come; see ReconstructorFeed.
///
/// Throws std::invalid_argument for options out of range, for what the reader and the
/// reconstructor throw it for, and EmptyRecording for one that has no event in the window.
Reconstruction reconstruct(camera::RecordingReader& recording, const ReconstructOptions& options,
                           const TakePicture& take);

}  // namespace nightjar::scenarios
