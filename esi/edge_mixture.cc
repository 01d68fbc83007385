#include "esi/edge_mixture.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "esi/best_instructions.h"

namespace nightjar::esi {
namespace {

constexpr int kEachRow = 4;
constexpr std::size_t kFeatures = kPixelFeatures, kInBlock = kPixelsABlock * kFeatures;

template <class To, class From>
void mix_values(From one, From other, int second, To&& to) {
  using Value = std::ranges::range_value_t<To>;
  constexpr std::int64_t kWhole = EdgeMixture::kWhole;
  std::ranges::transform(one, other, to.begin(), [=](std::int64_t a, std::int64_t b) {
    const std::int64_t sum = kWhole * a + second * (b - a);
    return static_cast<Value>((sum + kWhole / 2) >> EdgeMixture::kWholeBits);
  });
}

using Sums = std::array<std::int64_t, kInBlock>;

/// Of each of a block's features.
void add_row(const ChannelImage& features, int row, Sums& sums) {
  std::array<std::int32_t, kInBlock> of_row{};
  std::int32_t* sum = of_row.data();
  const std::int16_t* feature = features.at(0, row);
  const int width = features.width();
  with_best_instructions([=]() __attribute__((always_inline)) {
    for (int x = 0; x < width; ++x)
      for (std::size_t k = 0; k < kInBlock; ++k)
        sum[k] += feature[static_cast<std::size_t>(x) * kInBlock + k];
  });
  for (std::size_t k = 0; k < kInBlock; ++k) sums[k] += of_row[k];
}

}  // namespace

EdgeMixture::EdgeMixture() : mixed_{esi_net_edges()[0].layers, output_, output_bias_} {
  for (std::size_t i = 0; i < kEdgeLayers; ++i) {
    Convolution& layer = mixed_.layers[i];
    layers_[i].weights.resize(layer.weights.size());
    layers_[i].bias.resize(layer.bias.size());
    layer.weights = layers_[i].weights;
    layer.bias = layers_[i].bias;
  }
}

const EdgeWeights& EdgeMixture::mix(int second) {
  const auto& [one, other] = esi_net_edges();
  for (std::size_t i = 0; i < kEdgeLayers; ++i) {
    mix_values(one.layers[i].weights, other.layers[i].weights, second, layers_[i].weights);
    mix_values(one.layers[i].bias, other.layers[i].bias, second, layers_[i].bias);
  }
  mix_values(one.output, other.output, second, output_);
  mix_values(one.output_bias, other.output_bias, second, output_bias_);
  return mixed_;
}

int second_share(const ChannelImage& features,
                 std::span<const std::int32_t, kPixelFeatures + 1> gate) {
  Sums sums{};
  int rows = 0;
  for (int row = 0; row < features.height(); row += kEachRow, ++rows) add_row(features, row, sums);
  const double pixels = double{kPixelsABlock} * rows * features.width();
  double z = gate[kFeatures];
  for (std::size_t k = 0; k < kFeatures; ++k) {
    std::int64_t sum = 0;
    for (std::size_t i = k; i < kInBlock; i += kFeatures) sum += sums[i];
    z += gate[k] * (static_cast<double>(sum) / (pixels * kFeatureOne));
  }
  z /= 1 << kEsiNetWeightBits;
  return static_cast<int>(std::lround(EdgeMixture::kWhole * std::clamp(0.5 + z, 0.0, 1.0)));
}

}  // namespace nightjar::esi
