#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/event.h"
#include "core/part_file.h"

namespace nightjar::camera {

/// A sensor's events, ordered by time. Times are the recording's own.
struct EventRecording {
  core::Resolution size;
  std::vector<core::Event> events;
};

/// Reads the text format of the RPG event-camera data set and of v2e: one event a
/// line, `t_seconds x y polarity`, polarity 1 = ON, 0 or -1 = OFF. Lines that are
/// blank or start with # are passed over; lines end in LF or CRLF. Times are decimal
/// numbers ("0.5", "1e-06"), rounded to the nearest microsecond without going through
/// a double, so that Unix times stay exact.
///
/// The sensor is `size`; without it, the smallest that holds all events (0x0 when
/// there are none).
///
/// Throws std::invalid_argument "events.txt:12: x = 400, allowed 0 to 345" for the
/// first line that is not such an event, lies outside the sensor (32767x32767 when not
/// given) or is earlier than the one before; also when the file cannot be read, and for a
/// `size` that is empty or over 32767 a side.
EventRecording read_event_text(const std::filesystem::path& path,
                               std::optional<core::Resolution> size = std::nullopt);

/// As above, from a stream; `name` stands for the file in errors.
EventRecording read_event_text(std::istream& in, const std::string& name,
                               std::optional<core::Resolution> size = std::nullopt);

/// Writes the same format, as plain as the RPG files: no comments, six decimals,
/// polarity 1 or 0. The file has its name only after finish(): see PartFile.
class EventTextWriter {
 public:
  /// Throws std::invalid_argument when the folder does not exist or cannot be
  /// written, or when `path` is there and not a plain file.
  explicit EventTextWriter(std::filesystem::path path) : file_(std::move(path)) {}

  /// Throws std::invalid_argument for an event that could not be read back: earlier
  /// than the one before, before time 0, or at 32767 and beyond. Throws
  /// std::runtime_error when the disk does not take it.
  void write(std::span<const core::Event> events);

  /// Gives the file its name. Nothing may be written afterwards. Throws
  /// std::runtime_error when the disk does not take it.
  void finish() { file_.finish(); }

 private:
  core::PartFile file_;
  core::Time last_{};
};

}  // namespace nightjar::camera
