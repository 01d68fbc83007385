#include "camera/aedat31_writer.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <utility>

#include "camera/gray_level.h"
#include "camera/imu_axes.h"
#include "camera/packet_compression.h"
#include "camera/printable_text.h"
#include "camera/sensor_names.h"
#include "camera/trigger_types.h"

namespace nightjar::camera {
namespace {

constexpr std::uint32_t kValid = 1;
constexpr std::size_t kMostNameLength = 100;

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

std::int32_t low_bits(core::Time t) {
  return static_cast<std::int32_t>(t.count() & kAedat31TimeMask);
}

void append_frame(std::vector<std::byte>& bytes, const RecordedFrame& frame) {
  constexpr std::uint32_t kOneChannel = 1u << 1;
  append(bytes, kValid | kOneChannel);
  for (const core::Time t :
       {frame.frame_begin, frame.frame_end, frame.exposure_begin, frame.exposure_end})
    append(bytes, low_bits(t));
  for (const int number : {frame.gray.width(), frame.gray.height(), frame.left_px, frame.top_px})
    append(bytes, std::int32_t{number});
  constexpr int kBits = 16;  // as libcaer has it
  const core::Image<std::uint16_t> gray = with_bits(frame.gray, frame.bits, kBits);
  const auto pixels = std::as_bytes(gray.pixels());
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
}

}  // namespace

Aedat31Writer::Aedat31Writer(const std::filesystem::path& path, const RecordingHead& head)
    : head_(head), check_(head.size), file_(path) {}

void Aedat31Writer::write_header(core::Time start) {
  if (std::exchange(header_written_, true)) return;
  const std::string known = name_of(head_.size);
  // Times beyond year 9999 are none that a calendar could show.
  constexpr std::int64_t kMostCalendar_s = 253'402'300'799;
  const std::time_t start_s = std::min<std::int64_t>(start.count() / 1'000'000, kMostCalendar_s);
  file_.stream() << fmt::format(
      "{}\r\n#Format: RAW\r\n#Source 1: {}\r\n#Sensor: {} {}x{}\r\n"
      "#Start-Time: {:%Y-%m-%d %H:%M:%S} (TZ+0000)\r\n{}\r\n",
      kAedat31FirstLine, known.empty() ? "Unknown" : known,
      head_.camera.empty() ? "Nightjar" : printable_text(head_.camera, kMostNameLength),
      head_.size.width_px, head_.size.height_px, fmt::gmtime(start_s), kAedat31LastLine);
  file_.check();
}

void Aedat31Writer::begin_event(Aedat31Type type, std::int32_t size, core::Time t) {
  const auto overflow = static_cast<std::int32_t>(t.count() >> kAedat31TimeBits);
  const bool fits = static_cast<std::int16_t>(type) == packet_.type && size == packet_.event_size &&
                    overflow == packet_.overflow &&
                    events_.size() + static_cast<std::size_t>(size) <= kMostPacketBytes / 16;
  if (!fits) end_packet();
  packet_.type = static_cast<std::int16_t>(type);
  packet_.source = 1;
  packet_.event_size = size;
  packet_.overflow = overflow;
  packet_.capacity = ++packet_.number;
  packet_.valid = packet_.number;
}

void Aedat31Writer::end_packet() {
  if (packet_.number > 0) {
    file_.stream().write(reinterpret_cast<const char*>(&packet_), sizeof(packet_));
    file_.stream().write(reinterpret_cast<const char*>(events_.data()),
                         static_cast<std::streamsize>(events_.size()));
    file_.check();
  }
  packet_ = {};
  events_.clear();
}

void Aedat31Writer::write(const RecordingPart& part) {
  check_.check(part);
  write_header(part.first_time());
  for (const Trigger& trigger : part.triggers) {
    if (trigger.type == kTimestampWrap) {  // says what the packets' headers do
      ++not_carried_.triggers;
      continue;
    }
    begin_event(Aedat31Type::special, kAedat31EventBytes, trigger.t);
    append(events_, kValid | (static_cast<std::uint32_t>(trigger.type) << 1));
    append(events_, low_bits(trigger.t));
  }
  for (const core::Event& event : part.events) {
    begin_event(Aedat31Type::polarity, kAedat31EventBytes, event.t);
    append(events_, kValid | (event.on ? 2u : 0u) | (static_cast<std::uint32_t>(event.y) << 2) |
                        (static_cast<std::uint32_t>(event.x) << 17));
    append(events_, low_bits(event.t));
  }
  for (const RecordedFrame& frame : part.frames) {
    const auto pixels = static_cast<std::int32_t>(2 * frame.gray.pixels().size());
    begin_event(Aedat31Type::frame, kAedat31FrameBytes + pixels, frame.frame_begin);
    append_frame(events_, frame);
  }
  for (const RecordedImu& sample : part.imu) {
    begin_event(Aedat31Type::imu6, kAedat31Imu6Bytes, sample.t);
    append(events_, kValid);
    append(events_, low_bits(sample.t));
    const RawImu raw = from_camera_axes(sample);
    if (!fits_floats(sample)) ++not_carried_.imu_rounded;
    for (const float value : raw.acceleration_g) append(events_, value);
    for (const float value : raw.rate_deg_s) append(events_, value);
    append(events_, sample.temperature_c);
  }
  end_packet();
}

void Aedat31Writer::finish() {
  write_header(core::Time{});
  file_.finish();
}

}  // namespace nightjar::camera
