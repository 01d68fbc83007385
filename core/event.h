#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace nightjar::core {

/// Microseconds since the start of the run (simulation) or since the camera's
/// own zero (hardware, recordings).
using Time = std::chrono::microseconds;

/// Seconds as a double, for formulas.
constexpr double seconds(Time t) { return std::chrono::duration<double>(t).count(); }

/// The nearest whole microsecond to `s` seconds.
constexpr Time from_seconds(double s) {
  return Time(static_cast<std::int64_t>(s * 1e6 + (s < 0 ? -0.5 : 0.5)));
}

/// The most pixels along a side that any part of the project takes.
inline constexpr int kMostSide_px = 32767;

struct Resolution {
  int width_px = 0;
  int height_px = 0;

  constexpr int pixels() const { return width_px * height_px; }
  friend constexpr bool operator==(const Resolution&, const Resolution&) = default;
};

/// One change of log intensity by one contrast threshold. `x` counts columns to
/// the right and `y` rows downwards from the top left pixel; `on` means brighter.
struct Event {
  Time t;
  std::uint16_t x;
  std::uint16_t y;
  bool on;

  friend constexpr bool operator==(const Event&, const Event&) = default;
};

/// What the camera hands over at once: the events of (begin, end], ordered by time.
struct EventPacket {
  Time begin{};
  Time end{};
  std::vector<Event> events;
};

}  // namespace nightjar::core
