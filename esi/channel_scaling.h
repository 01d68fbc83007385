#pragma once

#include <cstdint>

#include "core/image.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// The size that halving makes of a side: a last pixel without a neighbour counts as two.
constexpr int halved(int side) { return (side + 1) / 2; }

/// Each pixel of `out` the mean of 2x2 of `in`, (sum + 2) >> 2, of values up to kMostValue either
/// way; an odd side's last pixel stands in for its missing neighbour. `out` has halved() sides; of
/// its channels those from `first` on are written, as many as `in` has.
void halve(const ChannelImage& in, ChannelImage& out, int first = 0);

/// Adds to each pixel of `out` that of `in` which halve() would make of it. The caller sees to
/// it that no value exceeds 16 bits.
void add_doubled(const ChannelImage& in, ChannelImage& out);

/// Each pixel of `out` from the nearest four of `in`, (9 a + 3 b + 3 c + d + 8) >> 4, the image
/// going on beyond its edges with what is there; `in` has halved() sides.
void double_smoothly(const core::Image<std::int32_t>& in, core::Image<std::int32_t>& out);

}  // namespace nightjar::esi
