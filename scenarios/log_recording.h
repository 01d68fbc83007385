#pragma once

#include <map>
#include <optional>
#include <string>

#include "camera/recording.h"
#include "camera/recording_intake.h"
#include "msg/log_reader.h"
#include "scenarios/repeat_filter.h"

namespace nightjar::scenarios {

/// The camera's part of an LCM log: one of ours (`nightjar run --record-events`, `nightjar
/// convert`) or what lcm-logger heard of our processes. Events whole or in pieces; frames,
/// inertial samples and triggers with what else msg/camera_notes.h has of them. A message
/// that does not decode is passed over and counted as damaged.
class LogRecording : public camera::RecordingReader {
 public:
  /// Throws as camera::open_recording() does. The sensor is the one that the log names, or
  /// that its first picture or frame has, or else `size`.
  LogRecording(msg::LogReader log, std::optional<core::Resolution> size);
  LogRecording(const LogRecording&) = delete;
  LogRecording& operator=(const LogRecording&) = delete;

  std::string format() const override { return "LCM log"; }
  std::string camera() const override { return sensor_.camera; }
  core::Resolution size() const override { return intake_.size(); }
  bool next(camera::RecordingPart& part) override;
  double progress() const override { return log_.progress(); }
  const camera::RecordingFaults& faults() const override { return intake_.faults(); }
  std::map<std::string, std::uint64_t> others() const override { return others_; }

 private:
  void take(const msg::Message& message, camera::RecordingPart& part);
  void decode(const msg::Message& message, camera::RecordingPart& part);
  void take_events(const msg::Bytes& packet, camera::RecordingPart& part);
  void take_frame(const msg::Bytes& bytes, camera::RecordingPart& part);
  void take_imu(const msg::Bytes& bytes, camera::RecordingPart& part);
  void count_other(const std::string& channel);
  void count_lost();

  msg::LogReader log_;
  msg::SensorNote sensor_;
  camera::RecordingIntake intake_{{}};
  RepeatFilter repeats_;
  std::optional<msg::ReadoutNote> readout_;          ///< Of the next frame.
  std::optional<msg::TemperatureNote> temperature_;  ///< Of the next inertial sample.
  std::map<std::string, std::uint64_t> others_;
};

}  // namespace nightjar::scenarios
