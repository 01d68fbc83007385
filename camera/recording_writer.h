#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "camera/packet_compression.h"
#include "camera/recording.h"

namespace nightjar::camera {

/// What a file tells of the camera.
struct RecordingHead {
  core::Resolution size;
  std::string camera;  ///< May be empty.
};

/// What was given to a writer and is not in its file, the format having no place for it.
struct NotCarried {
  bool sensor = false;  ///< Neither its size nor the camera's name.
  std::uint64_t frames = 0;
  std::uint64_t frames_rounded = 0;  ///< To 8 bits.
  std::uint64_t imu = 0;
  std::uint64_t imu_rounded = 0;  ///< To floats.
  std::uint64_t triggers = 0;

  /// "3 frames", one of each kind; none when all was carried.
  std::vector<std::string> things() const;
};

/// Writes a recording part by part; the file has its name only after finish(): see PartFile.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  /// Lists ordered as a RecordingReader gives them. Throws std::invalid_argument for what
  /// could not be read back (times before 0 or going backwards, pixels off the sensor),
  /// std::runtime_error when the disk does not take it.
  virtual void write(const RecordingPart& part) = 0;

  /// Nothing may be written afterwards. Throws std::runtime_error when the disk does not
  /// take it.
  virtual void finish() = 0;

  /// So far.
  const NotCarried& not_carried() const { return not_carried_; }

 protected:
  NotCarried not_carried_;
};

/// Creates a recording, in the format of its name's ending: .aedat4 (packed as told),
/// .aedat (AEDAT 3.1) or .txt (events alone). Throws std::invalid_argument for another
/// ending, a sensor that is empty or over 32767 a side, and where PartFile does.
std::unique_ptr<RecordingWriter> create_recording(const std::filesystem::path& path,
                                                  const RecordingHead& head,
                                                  Compression compression = Compression::lz4);

/// Throws std::invalid_argument "NAME = PATH, allowed ..." for a name that
/// create_recording() would refuse.
void check_recording_name(const std::string& name, const std::filesystem::path& path);

}  // namespace nightjar::camera
