#include "scenarios/recordings.h"

#include <stdexcept>

#include "core/config_check.h"
#include "msg/log_reader.h"
#include "scenarios/log_recording.h"
#include "scenarios/log_recording_writer.h"

namespace nightjar::scenarios {
namespace {

constexpr const char* kLogEnding = ".lcm";

}  // namespace

std::unique_ptr<camera::RecordingReader> open_recording(const std::filesystem::path& path,
                                                        std::optional<core::Resolution> size) {
  if (!msg::is_log(path)) return camera::open_recording(path, size);
  return std::make_unique<LogRecording>(msg::LogReader(path), size);
}

std::unique_ptr<camera::RecordingWriter> create_recording(const std::filesystem::path& path,
                                                          const camera::RecordingHead& head,
                                                          camera::Compression compression) {
  check_recording_name("recording", path);
  if (path.extension() != kLogEnding) return camera::create_recording(path, head, compression);
  core::check_range("size.width_px", head.size.width_px, 1, core::kMostSide_px);
  core::check_range("size.height_px", head.size.height_px, 1, core::kMostSide_px);
  return std::make_unique<LogRecordingWriter>(path, head);
}

void check_recording_name(const std::string& name, const std::filesystem::path& path) {
  if (path.extension() == kLogEnding) return;
  try {
    camera::check_recording_name(name, path);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + ", or .lcm");
  }
}

}  // namespace nightjar::scenarios
