#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "camera/aedat31_format.h"
#include "camera/recording_check.h"
#include "camera/recording_writer.h"
#include "core/part_file.h"

namespace nightjar::camera {

/// AEDAT 3.1 with one source; a packet a list and part, cut where the 31 bits of its time
/// stamps wrap. Inertial samples become floats. The header's start time is the first time
/// of the recording, taken as Unix time.
class Aedat31Writer : public RecordingWriter {
 public:
  Aedat31Writer(const std::filesystem::path& path, const RecordingHead& head);

  void write(const RecordingPart& part) override;
  void finish() override;

 private:
  void write_header(core::Time start);
  void begin_event(Aedat31Type type, std::int32_t size, core::Time t);
  void end_packet();

  RecordingHead head_;
  RecordingCheck check_;
  core::PartFile file_;
  bool header_written_ = false;
  Aedat31PacketHeader packet_;     ///< At hand: its header, ...
  std::vector<std::byte> events_;  ///< ... and its events so far.
};

}  // namespace nightjar::camera
