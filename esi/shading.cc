#include "esi/shading.h"

#include "esi/channel_scaling.h"
#include "esi/esi_net_weights.h"

namespace nightjar::esi {

Shading::Shading(int width, int height) {
  shades_.emplace_back(core::Resolution{width, height});
  for (std::size_t i = 0; i < kShadingLevels; ++i) {
    width = halved(width);
    height = halved(height);
    const ChannelImage image(width, height, kConvolutionOut);
    levels_.push_back(
        {i == 0 ? ChannelImage(width, height, 2 * kConvolutionOut) : image, image, image});
    if (i <= kShadeLevel) shades_.emplace(shades_.begin(), core::Resolution{width, height});
  }
}

const core::Image<std::int32_t>& Shading::of(const ChannelImage& second,
                                             const ChannelImage& third) {
  const Convolution* layer = esi_net_shading().data();
  halve(second, levels_[0].in);
  halve(third, levels_[0].in, kConvolutionOut);
  for (std::size_t i = 0; i < kShadingLevels; ++i) {
    if (i > 0) halve(levels_[i - 1].passed, levels_[i].in);
    convolve(*layer++, levels_[i].in, levels_[i].passed);
  }
  for (std::size_t i = kShadingLevels - 1; i > kShadeLevel; --i) {
    convolve(*layer++, levels_[i].passed, levels_[i].out);
    add_doubled(levels_[i].out, levels_[i - 1].passed);
  }
  Level& last = levels_[kShadeLevel];
  convolve(*layer, last.passed, last.out);
  for (int y = 0; y < last.out.height(); ++y)
    for (int x = 0; x < last.out.width(); ++x)
      shades_[0](x, y) = *last.out.at(x, y) * (1 << kEsiNetWeightBits);
  for (std::size_t i = 1; i < shades_.size(); ++i) double_smoothly(shades_[i - 1], shades_[i]);
  return shades_.back();
}

}  // namespace nightjar::esi
