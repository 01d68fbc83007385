#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "camera/recording.h"

namespace nightjar::test {

/// All of a recording at once.
struct WholeRecording {
  core::Resolution size;
  std::string format;
  std::string camera;
  camera::RecordingPart all;
  camera::RecordingFaults faults;
};

inline WholeRecording read_all(camera::RecordingReader& reader) {
  WholeRecording whole{reader.size(), reader.format(), reader.camera(), {}, {}};
  const auto append = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  for (camera::RecordingPart part; reader.next(part);) {
    append(whole.all.events, part.events);
    append(whole.all.frames, part.frames);
    append(whole.all.imu, part.imu);
    append(whole.all.triggers, part.triggers);
  }
  whole.faults = reader.faults();
  return whole;
}

inline WholeRecording read_all(const std::filesystem::path& path,
                               std::optional<core::Resolution> size = std::nullopt) {
  return read_all(*camera::open_recording(path, size));
}

/// The same from bytes; the file is called "dark.rec" in errors.
inline WholeRecording read_bytes(std::string bytes,
                                 std::optional<core::Resolution> size = std::nullopt) {
  return read_all(*camera::open_recording(std::make_unique<std::istringstream>(std::move(bytes)),
                                          "dark.rec", size));
}

}  // namespace nightjar::test
