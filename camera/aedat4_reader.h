#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "camera/byte_stream.h"
#include "camera/packet_compression.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

inline constexpr const char* kAedat4FirstLine = "#!AER-DAT4.0";

/// AEDAT4, as iniVation's DV writes it: camera/aedat4.fbs. Of each kind (events, frames,
/// IMU, triggers) the first stream is read, others are counted as unknown. A packet that
/// does not hold what it should is passed over and counted.
class Aedat4Reader : public RecordingReader {
 public:
  /// `stream` at its beginning. Throws as open_recording() does, with the byte.
  Aedat4Reader(ByteStream stream, std::optional<core::Resolution> size);

  std::string format() const override { return "AEDAT4"; }
  std::string camera() const override { return camera_; }
  core::Resolution size() const override { return intake_.size(); }
  bool next(RecordingPart& part) override;
  double progress() const override { return stream_.progress(); }
  const RecordingFaults& faults() const override { return intake_.faults(); }

 private:
  struct Packet {
    std::uint64_t offset = 0;  ///< Of its header.
    int stream = 0;
  };

  void read_header(std::optional<core::Resolution> size);
  void read_streams(const std::string& xml, std::optional<core::Resolution> size);
  std::optional<Packet> read_packet();
  std::optional<Packet> end_early(const std::string& why);
  void decode(const Packet& packet, RecordingPart& part);
  void decode_events(RecordingPart& part);
  void decode_frame(RecordingPart& part);
  void decode_imu(RecordingPart& part);
  void decode_triggers(RecordingPart& part);

  ByteStream stream_;
  RecordingIntake intake_;
  std::string camera_;
  Compression compression_ = Compression::none;
  std::uint64_t end_ = 0;                  ///< Of the packets.
  std::map<std::string, int> stream_of_;   ///< By the kind's four letters.
  std::vector<std::byte> packed_, bytes_;  ///< The packet at hand.
};

}  // namespace nightjar::camera
