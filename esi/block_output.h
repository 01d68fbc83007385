#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// The grey levels of 2x2 pixels, row by row, from all that is known of their block: the
/// last layer's values and the features themselves, which are sharper.
class BlockOutput {
 public:
  static constexpr int kPixels = 4;

  /// A pixel's sum is its bias, its weights times the values and its block's shade, and its level
  /// clamp(127.5 + levels * sum, 0, 255), rounded to the nearest.
  explicit BlockOutput(float levels) : levels_(levels) {}

  /// kPixels rows of equally many weights, an even number, for the values of a block, the
  /// hidden ones first.
  void set_weights(std::span<const std::int16_t> weights,
                   std::span<const std::int32_t, kPixels> bias);

  /// All three of one size; `gray` has twice their sides, or one pixel less at the right or the
  /// bottom. The same on every processor. The caller sees to it that no sum exceeds 32 bits.
  void write(const ChannelImage& hidden, const ChannelImage& features,
             const core::Image<std::int32_t>& shade, core::Image<std::uint8_t>& gray) const;

 private:
  using Levels = std::array<std::uint8_t, kPixels>;
  Levels levels_of(std::span<const std::int16_t> hidden, std::span<const std::int16_t> features,
                   std::int32_t shade) const;
  /// A row of blocks, from the pixel `from` on.
  void write_row(const ChannelImage& hidden, const ChannelImage& features,
                 const core::Image<std::int32_t>& shade, int row, int from,
                 core::Image<std::uint8_t>& gray) const;
  /// The same, two blocks at a time, of as many channels as make whole registers. Returns where
  /// the first pixel is that it has not written.
  int write_row_avx2(const ChannelImage& hidden, const ChannelImage& features,
                     const core::Image<std::int32_t>& shade, int row,
                     core::Image<std::uint8_t>& gray) const;

  /// [pairs of values][2 times the same][kPixels][2 of a pair]: a pair's, side by side.
  std::vector<std::int16_t> weights_;
  std::array<std::int32_t, kPixels> bias_{};
  float levels_;
};

}  // namespace nightjar::esi
