#pragma once

#include "camera/recording.h"

namespace nightjar::camera {

/// Sees that what a writer is given could be read back: every list ordered, on the sensor,
/// at times a recording can have.
class RecordingCheck {
 public:
  explicit RecordingCheck(core::Resolution size) : size_(size) {}

  /// Throws std::invalid_argument naming the first that does not.
  void check(const RecordingPart& part);

 private:
  core::Resolution size_;
  core::Time event_{}, frame_{}, imu_{}, trigger_{};  ///< The latest of each list.
};

}  // namespace nightjar::camera
