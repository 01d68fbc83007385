#pragma once

#include <optional>
#include <span>

#include "camera/recording.h"
#include "core/event.h"

namespace nightjar::scenarios {

/// A recording's events alone, in pieces that end where one asks them to.
class EventStream {
 public:
  /// `recording` has to outlive the stream.
  explicit EventStream(camera::RecordingReader& recording) : recording_(recording) {}

  /// The time of the next event; nothing at the end.
  std::optional<core::Time> next_time();

  /// Events at `t` or before, valid until the next call of this or of next_time(); none once
  /// all of those were given.
  std::span<const core::Event> take_until(core::Time t);

  /// From the first event to the last, as far as the recording's progress() tells.
  double estimated_duration_s() const { return estimated_duration_s_; }

 private:
  bool fill();

  camera::RecordingReader& recording_;
  camera::RecordingPart part_;
  std::span<const core::Event> left_;  ///< Of the part.
  std::optional<core::Time> begin_;
  double estimated_duration_s_ = 0;
};

}  // namespace nightjar::scenarios
