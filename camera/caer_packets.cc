#include "camera/caer_packets.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "camera/byte_stream.h"
#include "camera/gray_level.h"
#include "camera/imu_axes.h"
#include "camera/trigger_types.h"

namespace nightjar::camera {
namespace {

using Bytes = std::span<const std::byte>;

/// The least an event of the type takes; 0 for types we do not read.
std::int32_t least_size(std::int16_t type) {
  switch (static_cast<Aedat31Type>(type)) {
    case Aedat31Type::special:
    case Aedat31Type::polarity: return kAedat31EventBytes;
    case Aedat31Type::frame: return kAedat31FrameBytes;
    case Aedat31Type::imu6: return kAedat31Imu6Bytes;
  }
  return 0;
}

bool is_valid(Bytes event) { return (little_endian<std::uint32_t>(event, 0) & 1u) != 0; }

std::uint32_t bits(std::uint32_t value, int first, int count) {
  return (value >> first) & ((1u << count) - 1);
}

/// Undoes what a frame's times suffer when the 31 bits wrap within it.
core::Time after(core::Time begin, core::Time t) {
  constexpr core::Time kWrap(std::int64_t{1} << kAedat31TimeBits);
  return begin - t > kWrap / 2 ? t + kWrap : t;
}

/// One packet's events on their way from bytes to `part`.
class Decoder {
 public:
  Decoder(const Aedat31PacketHeader& header, RecordingIntake& intake, RecordingPart& part)
      : header_(header), intake_(intake), part_(part) {}

  void decode(Bytes event) {
    switch (static_cast<Aedat31Type>(header_.type)) {
      case Aedat31Type::special: special(event); break;
      case Aedat31Type::polarity: polarity(event); break;
      case Aedat31Type::frame: frame(event); break;
      case Aedat31Type::imu6: imu6(event); break;
    }
  }

 private:
  std::int64_t low_time(Bytes event, std::size_t at) const {
    return little_endian<std::int32_t>(event, at) & kAedat31TimeMask;
  }

  core::Time time_at(Bytes event, std::size_t at) const {
    return core::Time((std::int64_t{header_.overflow} << kAedat31TimeBits) | low_time(event, at));
  }

  void special(Bytes event) {
    const int type = static_cast<int>(bits(little_endian<std::uint32_t>(event, 0), 1, 7));
    if (type == kTimestampWrap) return;
    if (type == kTimestampReset) {
      intake_.expect_reset();
      // libcaer 3.3 container_generation.h: a reset has no time of its own, but the greatest
      if (low_time(event, 4) == kAedat31TimeMask) return;
    }
    intake_.add(Trigger{time_at(event, 4), type}, part_);
  }

  void polarity(Bytes event) {
    const auto data = little_endian<std::uint32_t>(event, 0);
    intake_.add(core::Event{time_at(event, 4), static_cast<std::uint16_t>(bits(data, 17, 15)),
                            static_cast<std::uint16_t>(bits(data, 2, 15)), bits(data, 1, 1) != 0},
                part_);
  }

  void frame(Bytes event) {
    const std::uint32_t channels = bits(little_endian<std::uint32_t>(event, 0), 1, 3);
    const auto number = [&](std::size_t at) { return little_endian<std::int32_t>(event, at); };
    const std::int32_t width = number(20), height = number(24);
    const Bytes pixels = event.subspan(kAedat31FrameBytes);
    const bool shape_is_sound = (channels == 1 || channels == 3 || channels == 4) && width >= 1 &&
                                width <= core::kMostSide_px && height >= 1 &&
                                height <= core::kMostSide_px;
    if (!shape_is_sound ||
        std::int64_t{2} * channels * width * height > static_cast<std::int64_t>(pixels.size())) {
      intake_.fault(&RecordingFaults::packets_damaged,
                    fmt::format("frame of {}x{} with {} channels in {} bytes", width, height,
                                channels, pixels.size()));
      return;
    }
    RecordedFrame frame;
    frame.frame_begin = time_at(event, 4);
    frame.frame_end = after(frame.frame_begin, time_at(event, 8));
    frame.exposure_begin = after(frame.frame_begin, time_at(event, 12));
    frame.exposure_end = after(frame.frame_begin, time_at(event, 16));
    frame.left_px = number(28);
    frame.top_px = number(32);
    frame.gray = core::Image<std::uint16_t>({width, height});
    fill(frame.gray, pixels, channels);
    frame.bits = drop_empty_bits(frame.gray);
    intake_.add(std::move(frame), part_);
  }

  static void fill(core::Image<std::uint16_t>& gray, Bytes pixels, std::uint32_t channels) {
    std::size_t at = 0;
    for (std::uint16_t& each : gray.pixels()) {
      const auto level = [&](std::size_t i) {
        return little_endian<std::uint16_t>(pixels, at + 2 * i);
      };
      each = channels == 1 ? level(0) : gray_level(level(0), level(1), level(2));
      at += 2 * channels;
    }
  }

  void imu6(Bytes event) {
    RawImu raw;
    for (std::size_t i = 0; i < 3; ++i) {
      raw.acceleration_g[i] = little_endian<float>(event, 8 + 4 * i);
      raw.rate_deg_s[i] = little_endian<float>(event, 20 + 4 * i);
    }
    intake_.add(to_camera_axes(time_at(event, 4), raw, little_endian<float>(event, 32)), part_);
  }

  const Aedat31PacketHeader& header_;
  RecordingIntake& intake_;
  RecordingPart& part_;
};

}  // namespace

void decode_caer_events(const Aedat31PacketHeader& header, Bytes events, RecordingIntake& intake,
                        RecordingPart& part) {
  const std::int32_t least = least_size(header.type);
  if (least == 0) {
    intake.fault(&RecordingFaults::packets_unknown,
                 fmt::format("of type {} from source {}", header.type, header.source));
    return;
  }
  if (header.event_size < least) {
    intake.fault(&RecordingFaults::packets_damaged,
                 fmt::format("of type {} with events of {} bytes, allowed {} or more", header.type,
                             header.event_size, least));
    return;
  }
  Decoder decoder(header, intake, part);
  const auto step = static_cast<std::size_t>(header.event_size);
  for (; events.size() >= step; events = events.subspan(step))
    if (is_valid(events)) decoder.decode(events.first(step));
}

void decode_caer_packet(Bytes packet, RecordingIntake& intake, RecordingPart& part) {
  if (packet.size() < sizeof(Aedat31PacketHeader)) {
    intake.fault(&RecordingFaults::packets_damaged,
                 fmt::format("of {} bytes, without a header", packet.size()));
    return;
  }
  const auto header = little_endian<Aedat31PacketHeader>(packet, 0);
  const Bytes there = packet.subspan(sizeof(header));
  const std::int64_t size = std::int64_t{header.event_size} * header.number;
  if (header.event_size < 1 || header.number < 0 || header.overflow < 0 ||
      size > static_cast<std::int64_t>(there.size())) {
    intake.fault(&RecordingFaults::packets_damaged,
                 fmt::format("of {} events of {} bytes in {} bytes", header.number,
                             header.event_size, there.size()));
    return;
  }
  decode_caer_events(header, there.first(static_cast<std::size_t>(size)), intake, part);
}

}  // namespace nightjar::camera
