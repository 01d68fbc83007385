#pragma once

#include <filesystem>

#include "camera/recording_check.h"
#include "camera/recording_writer.h"
#include "msg/log_writer.h"

namespace nightjar::scenarios {

/// Writes a recording as an LCM log that LogRecording reads back bit for bit and that
/// `nightjar replay` sends like any other: steps of 10 ms from the first event on, each with
/// its triggers, inertial samples and frames, and last its events. Where there are no events
/// for a second, the steps between are left out.
class LogRecordingWriter : public camera::RecordingWriter {
 public:
  /// Throws where core::PartFile does.
  LogRecordingWriter(const std::filesystem::path& path, const camera::RecordingHead& head);

  void write(const camera::RecordingPart& part) override;
  void finish() override;

 private:
  void write_head(core::Time t);
  void write_step();
  void write_triggers(core::Time until);
  void write_imu(core::Time until);
  void write_frames(core::Time until);

  template <class T>
  void put(const msg::Channel<T>& channel, const T& value) {
    log_.write(channel.name, msg::encode(value));
  }

  camera::RecordingHead head_;
  camera::RecordingCheck check_;
  msg::LogWriter log_;
  camera::RecordingPart waiting_;  ///< For its step.
  core::Time begin_{};             ///< Of the step at hand.
  bool begun_ = false, head_written_ = false;
};

}  // namespace nightjar::scenarios
