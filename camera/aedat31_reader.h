#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "camera/aedat31_format.h"
#include "camera/byte_stream.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

/// AEDAT 3.1, as cAER and libcaer write it. Of each kind the first source is read, others
/// are counted as unknown. What packets hold is decode_caer_events()'s to say.
class Aedat31Reader : public RecordingReader {
 public:
  /// `stream` at its beginning. Throws as open_recording() does, with the byte.
  Aedat31Reader(ByteStream stream, std::optional<core::Resolution> size);

  std::string format() const override { return "AEDAT 3.1"; }
  std::string camera() const override { return camera_; }
  core::Resolution size() const override { return intake_.size(); }
  bool next(RecordingPart& part) override;
  double progress() const override { return stream_.progress(); }
  const RecordingFaults& faults() const override { return intake_.faults(); }

 private:
  bool read_packet();
  bool end_early(std::uint64_t begin, const std::string& why);
  void decode(RecordingPart& part);

  ByteStream stream_;
  std::string camera_;
  RecordingIntake intake_{{}};
  std::map<std::int16_t, std::int16_t> source_of_;  ///< By the packet's type.
  Aedat31PacketHeader header_;                      ///< Of the packet at hand, ...
  std::vector<std::byte> bytes_;                    ///< ... its events.
};

}  // namespace nightjar::camera
