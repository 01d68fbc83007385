#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "camera/recording.h"

namespace nightjar::scenarios {

/// What is in a recording.
struct RecordingInfo {
  /// When the first and the last of a list were, on the recording's own clock.
  struct Span {
    core::Time first{};
    core::Time last{};

    double duration_s() const { return core::seconds(last - first); }
  };

  std::string format;
  std::string camera;  ///< May be empty.
  core::Resolution size;
  std::uint64_t events_on = 0;
  std::uint64_t events_off = 0;
  std::optional<Span> events;  ///< Nothing without events, and so on.
  std::uint64_t frames = 0;
  std::optional<Span> exposures;  ///< From the first's begin to the last's end.
  core::Time least_exposure{};
  core::Time most_exposure{};
  core::Resolution frame_size;  ///< Of the first.
  int frame_bits = 0;
  std::uint64_t imu_samples = 0;
  std::optional<Span> imu;
  std::uint64_t triggers = 0;
  std::map<std::string, std::uint64_t> others;  ///< See RecordingReader::others().
  camera::RecordingFaults faults;

  /// All events over their duration; 0 where that is none.
  double event_rate_hz() const;
};

/// Reads all of `recording`. After every part `on_progress` gets the share that is read;
/// it may throw to stop. Throws what the reader does.
RecordingInfo inspect(camera::RecordingReader& recording,
                      const std::function<void(double share)>& on_progress);

std::string to_json(const RecordingInfo& info);

/// As people read it.
std::string to_table(const RecordingInfo& info);

/// What was not as it should be, in one line; empty if nothing.
std::string fault_text(const camera::RecordingFaults& faults);

}  // namespace nightjar::scenarios
