#include "camera/event_text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace nightjar::camera {
namespace {

constexpr std::size_t kEventsPerPart = 10'000;
constexpr core::Resolution kAnySize{core::kMostSide_px, core::kMostSide_px};

/// As EventTextLines::next(), but a cut last line is the end.
bool next_whole(EventTextLines& lines, core::Event& event) {
  try {
    return lines.next(event);
  } catch (const std::invalid_argument&) {
    if (lines.bytes_of_cut_line() == 0) throw;
    return false;
  }
}

void rewind(std::istream& in, const std::string& name) {
  in.clear();
  in.seekg(0);
  if (!in) throw std::invalid_argument(fmt::format("{}: cannot be read", name));
}

/// The smallest sensor that holds all events; one pixel where there are none.
core::Resolution find_size(std::istream& in, const std::string& name) {
  EventTextLines lines(in, name, kAnySize);
  core::Resolution size{1, 1};
  for (core::Event event; next_whole(lines, event);) {
    size.width_px = std::max(size.width_px, event.x + 1);
    size.height_px = std::max(size.height_px, event.y + 1);
  }
  rewind(in, name);
  return size;
}

std::uint64_t length_of(std::istream& in, const std::string& name) {
  in.seekg(0, std::ios::end);
  const std::streamoff length = in.tellg();
  rewind(in, name);
  return static_cast<std::uint64_t>(std::max<std::streamoff>(length, 0));
}

}  // namespace

EventTextReader::EventTextReader(std::unique_ptr<std::istream> in, std::string name,
                                 std::optional<core::Resolution> size)
    : in_(std::move(in)),
      length_(length_of(*in_, name)),
      intake_(size ? *size : find_size(*in_, name)),
      lines_(*in_, std::move(name), kAnySize) {
  intake_.set_place([this] { return lines_.place(); });
}

double EventTextReader::progress() const {
  return length_ == 0 ? 1.0
                      : static_cast<double>(lines_.bytes_read()) / static_cast<double>(length_);
}

bool EventTextReader::next(RecordingPart& part) {
  part.clear();
  core::Event event;
  while (part.events.size() < kEventsPerPart && next_whole(lines_, event)) intake_.add(event, part);
  if (part.events.size() < kEventsPerPart) end();
  return !part.events.empty();
}

void EventTextReader::end() {
  if (in_->bad()) throw std::invalid_argument(lines_.place() + ": cannot be read");
  const std::uint64_t cut = lines_.bytes_of_cut_line();
  if (cut > 0 && !std::exchange(ended_, true))
    intake_.fault(&RecordingFaults::bytes_lost, "the last line is cut off", cut);
}

}  // namespace nightjar::camera
