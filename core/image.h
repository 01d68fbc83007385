#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "core/event.h"

namespace nightjar::core {

/// A dense picture, one channel, row-major, top row first.
template <class T>
class Image {
 public:
  Image() = default;
  explicit Image(Resolution size, T value = {})
      : size_(size), pixels_(static_cast<std::size_t>(size.pixels()), value) {}

  Resolution size() const { return size_; }
  int width() const { return size_.width_px; }
  int height() const { return size_.height_px; }
  bool empty() const { return pixels_.empty(); }

  T& operator()(int x, int y) { return pixels_[index(x, y)]; }
  const T& operator()(int x, int y) const { return pixels_[index(x, y)]; }

  std::span<T> pixels() { return pixels_; }
  std::span<const T> pixels() const { return pixels_; }

  friend bool operator==(const Image&, const Image&) = default;

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && x < size_.width_px && y >= 0 && y < size_.height_px);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width_px) +
           static_cast<std::size_t>(x);
  }

  Resolution size_;
  std::vector<T> pixels_;
};

/// An 8-bit picture made from events, as it was at `t`.
struct Picture {
  Time t{};
  Image<std::uint8_t> gray;
};

/// A frame of the active pixels (APS), exposed over [exposure_begin, exposure_end).
struct ApsFrame {
  Time exposure_begin{};
  Time exposure_end{};
  int bits = 8;               ///< 8, 10 or, in recordings, 16.
  Image<std::uint16_t> gray;  ///< 0 to 2^bits - 1.
};

}  // namespace nightjar::core
