#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// How bright surfaces are, from the edges around them: a pyramid of 3x3 layers that sees
/// 100 px and more each way. What it adds to a picture is smooth, a value for 8x8 pixels and
/// interpolated between, so that the edges stay as they are.
class Shading {
 public:
  /// The picture's size in blocks of 2x2 pixels.
  Shading(int width, int height);

  /// A value a block, in units of 2^-kEsiNetWeightBits / kFeatureOne deviations as the sums of
  /// BlockOutput, from the values that EsiNet's second and third layer have there. Valid until
  /// the next call.
  const core::Image<std::int32_t>& of(const ChannelImage& second, const ChannelImage& third);

 private:
  struct Level {
    ChannelImage in, passed, out;
  };

  std::vector<Level> levels_;  ///< The finest first.
  /// From that of the level that gives the shade to that of the blocks.
  std::vector<core::Image<std::int32_t>> shades_;
};

}  // namespace nightjar::esi
