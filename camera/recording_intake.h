#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "camera/recording.h"

namespace nightjar::camera {

/// The latest time a recording may hold: what the text format's 12 digits of seconds take.
inline constexpr core::Time kMostTime = std::chrono::seconds(999'999'999'999);

/// What every reader passes its data through: drops and counts what is off the sensor or
/// goes backwards, and carries the time over a reset of the camera's clock.
///
/// A list that steps back by more than a second, or at all after expect_reset(), is taken
/// for a reset: its times go on from the latest of any list. Each list meets the reset by
/// itself, since a file has them in turns.
class RecordingIntake {
 public:
  explicit RecordingIntake(core::Resolution size) : size_(size) {}

  /// Says where the data that is added next come from, as faults name it: "FILE: byte N".
  /// Called for the first fault only.
  void set_place(std::function<std::string()> place) { place_ = std::move(place); }

  void add(const core::Event& event, RecordingPart& part);
  void add(RecordedFrame frame, RecordingPart& part);
  void add(RecordedImu sample, RecordingPart& part);
  void add(Trigger trigger, RecordingPart& part);

  /// The file says that the clock begins anew hereabouts.
  void expect_reset();

  /// Counts one more of `count`.
  void fault(std::uint64_t RecordingFaults::*count, const std::string& why,
             std::uint64_t amount = 1);

  core::Resolution size() const { return size_; }
  const RecordingFaults& faults() const { return faults_; }

 private:
  enum List { kEvents, kFrames, kImu, kTriggers };

  struct Clock {
    std::size_t epoch = 0;  ///< Resets so far.
    core::Time last_raw{};
    core::Time last{};
    bool reset_expected = false;
  };

  /// The time `raw` of a list on the recording's one time line, or nothing if it cannot be.
  std::optional<core::Time> place_in_time(List list, core::Time raw);
  bool begin_epoch(Clock& clock, core::Time raw);

  core::Resolution size_;
  std::function<std::string()> place_;
  std::array<Clock, 4> clocks_;
  std::vector<core::Time> shifts_{core::Time{}};  ///< One an epoch.
  core::Time latest_{};
  RecordingFaults faults_;
};

}  // namespace nightjar::camera
