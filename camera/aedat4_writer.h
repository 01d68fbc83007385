#pragma once

#include <filesystem>
#include <span>

#include "camera/recording_check.h"
#include "camera/recording_writer.h"
#include "core/part_file.h"

namespace nightjar::camera {

/// AEDAT4 with four streams (events, frames, IMU, triggers), a packet a list and part, each
/// frame its own. There is no table of the packets at the end, which readers can do without
/// and which would grow with the file. Inertial samples become floats, frames 8 bits.
class Aedat4Writer : public RecordingWriter {
 public:
  Aedat4Writer(const std::filesystem::path& path, const RecordingHead& head,
               Compression compression);

  void write(const RecordingPart& part) override;
  void finish() override { file_.finish(); }

 private:
  void write_header(const RecordingHead& head);
  void write_events(std::span<const core::Event> events);
  void write_frame(const RecordedFrame& frame);
  void write_imu(std::span<const RecordedImu> samples);
  void write_triggers(std::span<const Trigger> triggers);
  void write_packet(int stream, std::span<const std::byte> plain);

  Compression compression_;
  RecordingCheck check_;
  core::PartFile file_;
};

}  // namespace nightjar::camera
