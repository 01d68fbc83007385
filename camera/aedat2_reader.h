#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/byte_stream.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

inline constexpr const char* kAedat2FirstLine = "#!AER-DAT2.0";

/// AEDAT 2.0, as jAER writes it for a DAVIS: events, and pulses at the external input as
/// triggers. Samples of the active pixels and of the inertial sensor are in the file as raw
/// numbers whose scale it does not tell: they are counted as unknown. Rows count upwards in
/// the file and are turned over. Times have 32 bits, which wrap at 2^31 or 2^32, as the
/// writer counts; both are undone.
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
  core::Time unwrapped(std::uint32_t t_us);

  ByteStream stream_;
  std::string camera_;
  RecordingIntake intake_{{}};
  std::vector<std::byte> bytes_;  ///< The records at hand, ...
  std::uint64_t begin_ = 0;       ///< ... where they begin, ...
  std::size_t at_ = 0;            ///< ... and the one that is decoded.
  std::uint32_t last_us_ = 0;
  std::int64_t wrapped_us_ = 0;
};

}  // namespace nightjar::camera
