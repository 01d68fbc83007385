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

// jAER DavisChip.java, a1db449.
constexpr std::uint32_t kNoEvent = 1u << 31;  // of the active pixels or the inertial sensor
constexpr std::uint32_t kExternal = 1u << 10;
constexpr std::uint32_t kOn = 1u << 11;
constexpr std::uint32_t kResetRead = 0, kSignalRead = 1, kImu = 3;  // of those without event

// Where the address has what: the lowest bit, and how many.
struct Field {
  int first = 0;
  int bits = 0;
};
constexpr Field kRow{22, 9}, kColumn{12, 10}, kKind{10, 2}, kLevel{0, 10}, kEdge{0, 3};
constexpr Field kImuCode{28, 3}, kImuCount{12, 16};

constexpr std::uint32_t value(std::uint32_t address, Field field) {
  return (address >> field.first) & ((1u << field.bits) - 1);
}

int trigger_type(std::uint32_t address) {
  switch (value(address, kEdge)) {
    case 2: return kExternalFalling;
    case 3: return kExternalRising;
    default: return kExternalPulse;
  }
}

bool is_wrap(std::uint32_t last_us, std::uint32_t t_us, std::int64_t period_us) {
  return t_us < kNearWrap_us && last_us < period_us && last_us >= period_us - kNearWrap_us;
}

}  // namespace

Aedat2Reader::Aedat2Reader(ByteStream stream, std::optional<core::Resolution> size)
    : stream_(std::move(stream)) {
  AedatHeader header = read_aedat_header(stream_, "", size);
  camera_ = std::move(header.camera);
  intake_ = RecordingIntake(header.size);
  frames_.emplace(core::Resolution{std::min(header.size.width_px, 1 << kColumn.bits),
                                   std::min(header.size.height_px, 1 << kRow.bits)});
  imu_.emplace(header.imu_scale);
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
    if (!part.empty()) return true;
  }
  take(frames_->finish(), part);
  imu_->finish();
  count_lost();
  return !part.empty();
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
  if ((address & kNoEvent) == 0) {
    decode_event(address, t, part);
  } else if (value(address, kKind) == kImu) {
    decode_imu(address, t, part);
  } else if (value(address, kKind) == kResetRead || value(address, kKind) == kSignalRead) {
    decode_read(address, t, part);
  } else {  // a second signal read, of cameras of 2013
    intake_.fault(&RecordingFaults::packets_unknown, "a read of another kind");
  }
}

void Aedat2Reader::decode_event(std::uint32_t address, core::Time t, RecordingPart& part) {
  if ((address & kExternal) != 0) {
    intake_.add(Trigger{t, trigger_type(address)}, part);
    return;
  }
  // A row beyond the top edge becomes one beyond every sensor.
  const int row = intake_.size().height_px - 1 - static_cast<int>(value(address, kRow));
  intake_.add(core::Event{t, static_cast<std::uint16_t>(value(address, kColumn)),
                          static_cast<std::uint16_t>(row), (address & kOn) != 0},
              part);
}

void Aedat2Reader::decode_read(std::uint32_t address, core::Time t, RecordingPart& part) {
  const core::Resolution size = frames_->size();
  const ApsRead read{t, size.width_px - 1 - static_cast<int>(value(address, kColumn)),
                     size.height_px - 1 - static_cast<int>(value(address, kRow)),
                     value(address, kKind) == kSignalRead,
                     static_cast<std::uint16_t>(value(address, kLevel))};
  if (read.x < 0 || read.y < 0) {
    intake_.fault(&RecordingFaults::events_outside, "a read outside the sensor");
    return;
  }
  take(frames_->add(read), part);
  count_lost();
}

void Aedat2Reader::decode_imu(std::uint32_t address, core::Time t, RecordingPart& part) {
  const auto count = static_cast<std::int16_t>(value(address, kImuCount));
  if (const auto sample = imu_->add(value(address, kImuCode), count, t)) intake_.add(*sample, part);
  count_lost();
}

void Aedat2Reader::take(std::optional<RecordedFrame> frame, RecordingPart& part) {
  if (!frame) return;
  // Addresses reach no further from the corner that they count from.
  frame->left_px += intake_.size().width_px - frames_->size().width_px;
  frame->top_px += intake_.size().height_px - frames_->size().height_px;
  intake_.add(std::move(*frame), part);
}

void Aedat2Reader::count_lost() {
  const std::uint64_t lost =
      frames_->frames_lost() + frames_->signals_without_reset() + imu_->records_lost();
  if (lost > lost_)
    intake_.fault(&RecordingFaults::packets_damaged, "of a frame or sample that is not whole",
                  lost - lost_);
  lost_ = lost;
}

}  // namespace nightjar::camera
