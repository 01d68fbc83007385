#pragma once

#include <cstdint>

#include "core/image.h"

namespace nightjar::camera {

/// The grey of a colour, by Rec. ITU-R BT.709 in ten-thousandths, rounded.
constexpr std::uint16_t gray_level(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return static_cast<std::uint16_t>((2126 * red + 7152 * green + 722 * blue + 5000) / 10000);
}

/// Brings pixels that were shifted to the top of 16 bits down to 8, or else 10, if that
/// loses nothing; returns their bits, 16 if neither does.
int drop_empty_bits(core::Image<std::uint16_t>& gray);

/// `gray` of `bits` brought to `wanted` bits by shifting.
core::Image<std::uint16_t> with_bits(core::Image<std::uint16_t> gray, int bits, int wanted);

}  // namespace nightjar::camera
