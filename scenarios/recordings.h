#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "camera/recording_writer.h"

// Every format of recording: those of camera/, and LCM logs, which camera/ does not know.
namespace nightjar::scenarios {

/// Opens a camera's recording (camera::open_recording()) or an LCM log (LogRecording); its
/// content tells which. Throws as camera::open_recording() does.
std::unique_ptr<camera::RecordingReader> open_recording(
    const std::filesystem::path& path, std::optional<core::Resolution> size = std::nullopt);

/// As camera::create_recording(), and for a name ending in .lcm an LCM log.
std::unique_ptr<camera::RecordingWriter> create_recording(
    const std::filesystem::path& path, const camera::RecordingHead& head,
    camera::Compression compression = camera::Compression::lz4);

/// Throws std::invalid_argument "NAME = PATH, allowed ..." for a name that
/// create_recording() would refuse.
void check_recording_name(const std::string& name, const std::filesystem::path& path);

}  // namespace nightjar::scenarios
