#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/aedat2_imu.h"
#include "camera/aps_assembler.h"
#include "camera/byte_stream.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

inline constexpr const char* kAedat2FirstLine = "#!AER-DAT2.0";

/// AEDAT 2.0, as jAER writes it for a DAVIS: events, frames out of their pixels' single reads
/// (ApsAssembler), inertial samples (Aedat2Imu), and signals at the external input as
/// triggers. Rows count upwards in the file and are turned over; columns of active pixels
/// count the other way round than those of events (jAER DavisBaseCamera.java, a1db449, turns
/// the events' about) and are brought to theirs. Times have 32 bits, which wrap at 2^31 or 2^32, as
/// the writer counts; both are undone.
class Aedat2Reader : public RecordingReader {
 public:
  /// `stream` at its beginning. Throws as open_recording() does, with the byte.
  Aedat2Reader(ByteStream stream, std::optional<core::Resolution> size);

  std::string format() const override { return "AEDAT 2.0"; }
  std::string camera() const override { return camera_; }
  core::Resolution size() const override { return intake_.size(); }
  bool next(RecordingPart& part) override;
  double progress() const override { return stream_.progress(); }
  const RecordingFaults& faults() const override { return intake_.faults(); }

 private:
  bool read_records();
  void decode(std::uint32_t address, core::Time t, RecordingPart& part);
  void decode_event(std::uint32_t address, core::Time t, RecordingPart& part);
  void decode_read(std::uint32_t address, core::Time t, RecordingPart& part);
  void decode_imu(std::uint32_t address, core::Time t, RecordingPart& part);
  void take(std::optional<RecordedFrame> frame, RecordingPart& part);
  void count_lost();
  core::Time unwrapped(std::uint32_t t_us);

  ByteStream stream_;
  std::string camera_;
  RecordingIntake intake_{{}};
  std::optional<ApsAssembler> frames_;  ///< From the beginning on, ...
  std::optional<Aedat2Imu> imu_;        ///< ... once the header is read.
  std::uint64_t lost_ = 0;              ///< Of what they lost, how much is counted.
  std::vector<std::byte> bytes_;        ///< The records at hand, ...
  std::uint64_t begin_ = 0;             ///< ... where they begin, ...
  std::size_t at_ = 0;                  ///< ... and the one that is decoded.
  std::uint32_t last_us_ = 0;
  std::int64_t wrapped_us_ = 0;
};

}  // namespace nightjar::camera
