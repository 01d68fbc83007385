#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "esi/esi_net_weights.h"

namespace nightjar::esi {

/// The edges' weights for one picture: bright scenes in quick motion have little but signal, dark
/// ones little but noise, and weights that serve both serve neither as well as their own do
/// (docs/decisions/0009). So there are two sets, mixed as the picture's features say. All
/// in whole numbers from the share on.
class EdgeMixture {
 public:
  static constexpr int kWholeBits = 8, kWhole = 1 << kWholeBits;

  EdgeMixture();
  EdgeMixture(const EdgeMixture&) = delete;
  EdgeMixture& operator=(const EdgeMixture&) = delete;

  /// (1 - s) times the first set and s times the second, rounded to the nearest, for
  /// s = `second` / kWhole, 0 to 1. Valid until the next call.
  const EdgeWeights& mix(int second);

 private:
  struct Layer {
    std::vector<std::int16_t> weights;
    std::vector<std::int32_t> bias;
  };
  std::array<Layer, kEdgeLayers> layers_;
  std::array<std::int16_t, kPixelsABlock * kEsiNetOutputIn> output_{};
  std::array<std::int32_t, kPixelsABlock> output_bias_{};
  EdgeWeights mixed_;
};

/// What of the second set a picture wants, 0 to EdgeMixture::kWhole for clamp(1/2 + z, 0, 1): z is
/// the bias and the weights of `gate`, as esi_net_gate() has them, times the means of a pixel's
/// features over each fourth row of blocks, from the first on. The same on every processor.
int second_share(const ChannelImage& features,
                 std::span<const std::int32_t, kPixelFeatures + 1> gate);

}  // namespace nightjar::esi
