#include "camera/event_text.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "camera/event_text_lines.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {
namespace {

std::string seconds_text(core::Time t) {
  return fmt::format("{}.{:06}", t.count() / 1'000'000, t.count() % 1'000'000);
}

core::Resolution smallest_size(std::span<const core::Event> events) {
  core::Resolution size;
  for (const core::Event& event : events) {
    size.width_px = std::max(size.width_px, event.x + 1);
    size.height_px = std::max(size.height_px, event.y + 1);
  }
  return size;
}

}  // namespace

EventRecording read_event_text(const std::filesystem::path& path,
                               std::optional<core::Resolution> size) {
  std::ifstream in(path, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(path, ignored))
    throw std::invalid_argument(fmt::format("{}: cannot be read", path.string()));
  return read_event_text(in, path.string(), size);
}

EventRecording read_event_text(std::istream& in, const std::string& name,
                               std::optional<core::Resolution> size) {
  EventTextLines lines(in, name,
                       size.value_or(core::Resolution{core::kMostSide_px, core::kMostSide_px}));
  EventRecording recording;
  for (core::Event event; lines.next(event);) {
    if (!recording.events.empty() && event.t < recording.events.back().t)
      throw std::invalid_argument(fmt::format("{}: t_seconds = {}, allowed {} or later",
                                              lines.place(), seconds_text(event.t),
                                              seconds_text(recording.events.back().t)));
    recording.events.push_back(event);
  }
  if (in.bad()) throw std::invalid_argument(fmt::format("{}: cannot be read", name));
  recording.size = size.value_or(smallest_size(recording.events));
  return recording;
}

void EventTextWriter::write(std::span<const core::Event> events) {
  fmt::memory_buffer buffer;
  for (const core::Event& event : events) {
    if (event.t < last_ || event.t > kMostTime || event.x >= core::kMostSide_px ||
        event.y >= core::kMostSide_px)
      throw std::invalid_argument(fmt::format("event at {} us, x = {}, y = {}: cannot follow {} us",
                                              event.t.count(), event.x, event.y, last_.count()));
    last_ = event.t;
    fmt::format_to(std::back_inserter(buffer), FMT_COMPILE("{}.{:06} {} {} {}\n"),
                   event.t.count() / 1'000'000, event.t.count() % 1'000'000, event.x, event.y,
                   event.on ? 1 : 0);
  }
  file_.stream().write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  file_.check();
}

}  // namespace nightjar::camera
