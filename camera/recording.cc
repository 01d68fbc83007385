#include "camera/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "camera/aedat2_reader.h"
#include "camera/aedat31_reader.h"
#include "camera/aedat4_reader.h"
#include "camera/byte_stream.h"
#include "camera/event_text_reader.h"
#include "camera/printable_text.h"
#include "core/config_check.h"

namespace nightjar::camera {
namespace {

constexpr std::string_view kAedat = "#!AER-DAT";
constexpr std::size_t kVersionLength = 3;  // "4.0"

/// What stands behind #!AER-DAT; empty where that is not how the file begins.
std::string aedat_version(std::istream& in) {
  std::string begin(kAedat.size() + kVersionLength, '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  in.clear();
  in.seekg(0);
  return begin.starts_with(kAedat) ? begin.substr(kAedat.size()) : "";
}

}  // namespace

void RecordingPart::clear() {
  events.clear();
  frames.clear();
  imu.clear();
  triggers.clear();
}

bool RecordingPart::empty() const {
  return events.empty() && frames.empty() && imu.empty() && triggers.empty();
}

core::Time RecordingPart::first_time() const {
  core::Time first = core::Time::max();
  if (!events.empty()) first = std::min(first, events.front().t);
  if (!frames.empty()) first = std::min(first, frames.front().frame_begin);
  if (!imu.empty()) first = std::min(first, imu.front().t);
  if (!triggers.empty()) first = std::min(first, triggers.front().t);
  return empty() ? core::Time{} : first;
}

std::unique_ptr<RecordingReader> open_recording(const std::filesystem::path& path,
                                                std::optional<core::Resolution> size) {
  auto in = std::make_unique<std::ifstream>(path, std::ios::binary);
  std::error_code ignored;
  if (!*in || !std::filesystem::is_regular_file(path, ignored))
    throw std::invalid_argument(fmt::format("{}: cannot be read", path.string()));
  return open_recording(std::move(in), path.string(), size);
}

std::unique_ptr<RecordingReader> open_recording(std::unique_ptr<std::istream> in,
                                                const std::string& name,
                                                std::optional<core::Resolution> size) {
  if (size) {
    core::check_range("size.width_px", size->width_px, 1, core::kMostSide_px);
    core::check_range("size.height_px", size->height_px, 1, core::kMostSide_px);
  }
  const std::string version = aedat_version(*in);
  if (version.empty()) return std::make_unique<EventTextReader>(std::move(in), name, size);
  ByteStream stream(std::move(in), name);
  if (version == "2.0") return std::make_unique<Aedat2Reader>(std::move(stream), size);
  if (version == "3.1") return std::make_unique<Aedat31Reader>(std::move(stream), size);
  if (version == "4.0") return std::make_unique<Aedat4Reader>(std::move(stream), size);
  throw std::invalid_argument(
      fmt::format("{}: AEDAT {}, allowed 2.0, 3.1 and 4.0", name, printable_text(version)));
}

}  // namespace nightjar::camera
