#pragma once

#include <cstdint>

#include "core/event.h"

namespace nightjar::esi {

/// An event in 8 bytes, the pixel's place worked out: what the loops over events read.
struct PackedEvent {
  std::uint32_t t_us;      ///< low_us() of the event's time.
  std::uint32_t pixel_on;  ///< (y * width + x) * 2, plus 1 for ON.

  std::uint32_t pixel() const { return pixel_on >> 1; }
  bool on() const { return (pixel_on & 1u) != 0; }

  friend bool operator==(const PackedEvent&, const PackedEvent&) = default;
};
static_assert(sizeof(PackedEvent) == 8);

/// The low 32 bits of a time. The difference of two is right, modulo 2^32, whatever the
/// times' own zero is, and a time difference as long as that is below 71 minutes.
constexpr std::uint32_t low_us(core::Time t) { return static_cast<std::uint32_t>(t.count()); }

/// The event as packed for a sensor `width_px` wide.
constexpr PackedEvent pack(const core::Event& e, int width_px) {
  const std::uint32_t pixel = std::uint32_t{e.y} * static_cast<std::uint32_t>(width_px) + e.x;
  return {low_us(e.t), pixel << 1 | std::uint32_t{e.on}};
}

}  // namespace nightjar::esi
