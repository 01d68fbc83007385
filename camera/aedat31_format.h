#pragma once

#include <cstddef>
#include <cstdint>

namespace nightjar::camera {

// AEDAT 3.1, all numbers little-endian. A packet is a header of 28 bytes and `number`
// events of `event_size` bytes.
inline constexpr const char* kAedat31FirstLine = "#!AER-DAT3.1";
inline constexpr const char* kAedat31LastLine = "#!END-HEADER";

enum class Aedat31Type : std::int16_t { special = 0, polarity = 1, frame = 2, imu6 = 3 };

struct Aedat31PacketHeader {
  std::int16_t type = 0;
  std::int16_t source = 0;
  std::int32_t event_size = 0;
  std::int32_t time_offset = 4;  ///< Of the time stamp in an event.
  std::int32_t overflow = 0;     ///< Bits 31 and up of its time.
  std::int32_t capacity = 0;
  std::int32_t number = 0;
  std::int32_t valid = 0;
};
static_assert(sizeof(Aedat31PacketHeader) == 28);

// Bytes of an event: of a frame without its pixels, of 16 bits each.
inline constexpr std::int32_t kAedat31EventBytes = 8;
inline constexpr std::int32_t kAedat31FrameBytes = 36;
inline constexpr std::int32_t kAedat31Imu6Bytes = 36;

inline constexpr int kAedat31TimeBits = 31;
inline constexpr std::int64_t kAedat31TimeMask = (std::int64_t{1} << kAedat31TimeBits) - 1;

}  // namespace nightjar::camera
