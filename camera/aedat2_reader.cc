#include "camera/aedat2_reader.h"

#include <algorithm>
#include <utility>

#include "camera/aedat_header.h"
#include "camera/trigger_types.h"

namespace nightjar::camera {
namespace {

constexpr std::size_t kRecordBytes = 8;
constexpr std::size_t kRecordsPerPart = 65536;

// Before and after a wrap there is some event within a minute.
constexpr std::uint32_t kNearWrap_us = 60'000'000;

constexpr std::uint32_t kNoEvent = 1u << 31;  // of the active pixels or the inertial sensor
constexpr std::uint32_t kExternal = 1u << 10;
constexpr std::uint32_t kOn = 1u << 11;

bool is_wrap(std::uint32_t last_us, std::uint32_t t_us, std::int64_t period_us) {
  return t_us < kNearWrap_us && last_us < period_us && last_us >= period_us - kNearWrap_us;
}

}  // namespace

Aedat2Reader::Aedat2Reader(ByteStream stream, std::optional<core::Resolution> size)
    : stream_(std::move(stream)) {
  AedatHeader header = read_aedat_header(stream_, "", size);
  camera_ = std::move(header.camera);
  intake_ = RecordingIntake(header.size);
  intake_.set_place([this] { return stream_.at(begin_ + at_, "record"); });
}

bool Aedat2Reader::read_records() {
  begin_ = stream_.offset();
  at_ = 0;
  const std::uint64_t whole = stream_.left() - stream_.left() % kRecordBytes;
  if (whole == 0) {
    if (stream_.left() == 0) return false;
    intake_.fault(&RecordingFaults::bytes_lost, "ends early", stream_.left());
    stream_.skip_to(begin_ + stream_.left());
    return false;
  }
  stream_.read(std::min<std::uint64_t>(whole, kRecordsPerPart * kRecordBytes), bytes_);
  return true;
}

bool Aedat2Reader::next(RecordingPart& part) {
  part.clear();
  while (read_records()) {
    for (; at_ < bytes_.size(); at_ += kRecordBytes)
      decode(big_endian_u32(bytes_, at_), unwrapped(big_endian_u32(bytes_, at_ + 4)), part);
    if (!part.events.empty() || !part.triggers.empty()) return true;
  }
  return false;
}

core::Time Aedat2Reader::unwrapped(std::uint32_t t_us) {
  for (const int period_bits : {31, 32}) {
    const std::int64_t period_us = std::int64_t{1} << period_bits;
    if (is_wrap(last_us_, t_us, period_us)) wrapped_us_ += period_us;
    // A late one from before the wrap.
    if (wrapped_us_ >= period_us && is_wrap(t_us, last_us_, period_us)) wrapped_us_ -= period_us;
  }
  last_us_ = t_us;
  return core::Time(wrapped_us_ + t_us);
}

void Aedat2Reader::decode(std::uint32_t address, core::Time t, RecordingPart& part) {
  if ((address & kNoEvent) != 0) {
    intake_.fault(&RecordingFaults::packets_unknown, "of the active pixels or inertial sensor");
    return;
  }
  if ((address & kExternal) != 0) {
    intake_.add(Trigger{t, kExternalPulse}, part);
    return;
  }
  const auto x = static_cast<std::uint16_t>((address >> 12) & 0x3ff);
  const int up = static_cast<int>((address >> 22) & 0x1ff);
  // A row beyond the top edge becomes one beyond every sensor.
  const auto y = static_cast<std::uint16_t>(intake_.size().height_px - 1 - up);
  intake_.add(core::Event{t, x, y, (address & kOn) != 0}, part);
}

}  // namespace nightjar::camera
