#include "camera/aedat_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "camera/printable_text.h"
#include "camera/sensor_names.h"

namespace nightjar::camera {
namespace {

constexpr std::uint64_t kMostHeaderBytes = std::uint64_t{16} << 20;
constexpr std::string_view kJaerLastLine = "#End Of ASCII Header";
constexpr std::size_t kMostNameLength = 100;
constexpr std::size_t kMostLineBytes = std::size_t{1} << 20;

/// What follows `key`, without blanks around it; nothing if `line` begins otherwise.
std::optional<std::string_view> value_of(std::string_view line, std::string_view key) {
  if (!line.starts_with(key)) return std::nullopt;
  line.remove_prefix(key.size());
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return line.substr(0, line.find_last_not_of(' ') + 1);
}

/// "346x260"; 0x0 for anything else.
core::Resolution parse_size(std::string_view text) {
  core::Resolution size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width_px);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return {};
  const auto height = std::from_chars(width.ptr + 1, end, size.height_px);
  if (height.ec != std::errc() || height.ptr != end) return {};
  return size;
}

void take_line(std::string_view line, AedatHeader& header) {
  if (const auto sensor = value_of(line, "#Sensor:")) {
    const std::size_t blank = std::min(sensor->rfind(' '), sensor->size());
    const core::Resolution size = parse_size(sensor->substr(std::min(blank + 1, sensor->size())));
    if (size == core::Resolution{}) return;
    header.camera = printable_text(sensor->substr(0, blank), kMostNameLength);
    header.size = size;
  }
  if (header.size != core::Resolution{}) return;
  std::optional<std::string_view> name = value_of(line, "# AEChip:");
  if (line.starts_with("#Source ")) name = value_of(line.substr(line.find(':') + 1), "");
  if (!name) return;
  if (header.camera.empty()) header.camera = printable_text(*name, kMostNameLength);
  if (const auto size = sensor_of(*name)) {
    header.camera = printable_text(*name, kMostNameLength);
    header.size = *size;
  }
}

core::Resolution checked_size(core::Resolution told, std::optional<core::Resolution> size,
                              const ByteStream& stream) {
  const auto fail = [&](const std::string& why) {
    throw std::invalid_argument(stream.at(0, "the header " + why));
  };
  if (told == core::Resolution{} && !size)
    fail("does not tell the sensor's size: it has to be given");
  if (told == core::Resolution{}) return *size;
  if (std::min(told.width_px, told.height_px) < 1 ||
      std::max(told.width_px, told.height_px) > core::kMostSide_px)
    fail(fmt::format("says {}x{} px, allowed 1 to {} a side", told.width_px, told.height_px,
                     core::kMostSide_px));
  if (size && *size != told)
    fail(fmt::format("says {}x{} px, expected {}x{}", told.width_px, told.height_px, size->width_px,
                     size->height_px));
  return told;
}

}  // namespace

AedatHeader read_aedat_header(ByteStream& stream, std::string_view end,
                              std::optional<core::Resolution> size) {
  AedatHeader header;
  while (!end.empty() || stream.peek() == '#') {
    const std::uint64_t begin = stream.offset();
    const std::string line = stream.read_line(kMostLineBytes);
    if (line == end || line == kJaerLastLine) break;
    if (end.empty() && line.find('\0') != std::string::npos) {  // an event of row 140
      stream.skip_to(begin);
      break;
    }
    if (stream.offset() > kMostHeaderBytes || !line.starts_with('#'))
      throw std::invalid_argument(stream.at(begin, "the header does not end"));
    const auto format = value_of(line, "#Format:");
    if (format && *format != "RAW")
      throw std::invalid_argument(stream.at(begin, "another format than RAW"));
    take_line(line, header);
    header.imu_scale.take(line);
  }
  header.size = checked_size(header.size, size, stream);
  return header;
}

}  // namespace nightjar::camera
