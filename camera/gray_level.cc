#include "camera/gray_level.h"

#include <algorithm>
#include <utility>

namespace nightjar::camera {

int drop_empty_bits(core::Image<std::uint16_t>& gray) {
  constexpr int kFull = 16;
  std::uint16_t used = 0;
  for (const std::uint16_t level : gray.pixels()) used |= level;
  for (const int bits : {8, 10}) {
    if ((used & ((1u << (kFull - bits)) - 1)) != 0) continue;
    gray = with_bits(std::move(gray), kFull, bits);
    return bits;
  }
  return kFull;
}

core::Image<std::uint16_t> with_bits(core::Image<std::uint16_t> gray, int bits, int wanted) {
  const int up = std::max(0, wanted - bits), down = std::max(0, bits - wanted);
  for (std::uint16_t& level : gray.pixels())
    level = static_cast<std::uint16_t>((level << up) >> down);
  return gray;
}

}  // namespace nightjar::camera
