#include "esi/edge_mixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr int kChannels = static_cast<int>(kPixelsABlock) * kPixelFeatures;

void expect_between(const auto& one, const auto& other, double share, const auto& mixed) {
  ASSERT_EQ(mixed.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i)  // to the nearest whole number
    ASSERT_NEAR(mixed[i], (1 - share) * one[i] + share * other[i], 0.5) << i;
}

TEST(EdgeMixture, lies_between_the_two_sets_and_is_each_at_its_end) {
  const auto& [one, other] = esi_net_edges();
  EdgeMixture mixture;
  for (const int second : {0, 256, 128, 77}) {
    const EdgeWeights& mixed = mixture.mix(second);
    const double share = second / 256.0;
    for (std::size_t i = 0; i < kEdgeLayers; ++i) {
      const Convolution& layer = mixed.layers[i];
      expect_between(one.layers[i].weights, other.layers[i].weights, share, layer.weights);
      expect_between(one.layers[i].bias, other.layers[i].bias, share, layer.bias);
      EXPECT_EQ(layer.in, one.layers[i].in);
      EXPECT_EQ(layer.shift, one.layers[i].shift);
      EXPECT_EQ(layer.shift, other.layers[i].shift);
      EXPECT_EQ(layer.least, one.layers[i].least);
    }
    expect_between(one.output, other.output, share, mixed.output);
    expect_between(one.output_bias, other.output_bias, share, mixed.output_bias);
  }
  EXPECT_TRUE(std::ranges::equal(mixture.mix(0).output, one.output));
  EXPECT_TRUE(std::ranges::equal(mixture.mix(256).output, other.output));
}

/// `value` for pixels' feature `of`, 0 for the others.
ChannelImage features_with(int of, int value, int width, int height) {
  ChannelImage features(width, height, kChannels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int i = of; i < kChannels; i += kPixelFeatures)
        features.at(x, y)[i] = static_cast<std::int16_t>(value);
  return features;
}

/// A weight of `weight` for the feature `of`, none for the others.
std::array<std::int32_t, kPixelFeatures + 1> gate_for(int of, double weight, double bias) {
  std::array<std::int32_t, kPixelFeatures + 1> gate{};
  gate[static_cast<std::size_t>(of)] = static_cast<std::int32_t>(weight * (1 << kEsiNetWeightBits));
  gate.back() = static_cast<std::int32_t>(bias * (1 << kEsiNetWeightBits));
  return gate;
}

TEST(SecondShare, weighs_each_feature_by_its_mean_over_the_picture) {
  for (int of = 0; of < kPixelFeatures; ++of) {
    const ChannelImage features = features_with(of, 512, 7, 5);  // 1
    EXPECT_EQ(second_share(features, gate_for(of, 0.25, 0)), 192);
    EXPECT_EQ(second_share(features, gate_for(of, -0.5, 0.125)), 32);
    EXPECT_EQ(second_share(features, gate_for((of + 1) % kPixelFeatures, 7, 0)), 128);
  }
  ChannelImage half = features_with(1, 0, 10, 1);  // -1 in half of the columns
  for (int x = 0; x < 5; ++x)
    for (int i = 1; i < kChannels; i += kPixelFeatures) half.at(x, 0)[i] = -512;
  EXPECT_EQ(second_share(half, gate_for(1, 0.25, 0)), 96);
}

TEST(SecondShare, is_nothing_or_all_far_from_even_odds) {
  const ChannelImage features = features_with(3, 512, 2, 2);
  EXPECT_EQ(second_share(features, gate_for(3, -0.5, 0)), 0);
  EXPECT_EQ(second_share(features, gate_for(3, -7, 0)), 0);
  EXPECT_EQ(second_share(features, gate_for(3, 0.5, 0)), 256);
  EXPECT_EQ(second_share(features, gate_for(3, 7, 0)), 256);
}

TEST(SecondShare, looks_at_each_fourth_row_and_at_the_rim_never) {
  core::Random random = core::random_stream(/*seed=*/1, "test.edge_mixture");
  const auto gate = gate_for(2, 0.25, 0);
  ChannelImage features = features_with(2, 512, 6, 9);
  for (int y = -1; y <= 9; ++y)
    for (int i = 0; i < kChannels; ++i) {
      for (const int x : {-1, 6}) features.at(x, y)[i] = 1000;
      if (y % 4 == 0) continue;
      for (int x = 0; x < 6; ++x) features.at(x, y)[i] = static_cast<std::int16_t>(random() % 1024);
    }
  EXPECT_EQ(second_share(features, gate), 192);
  for (int i = 0; i < kChannels; ++i) features.at(3, 8)[i] = 0;  // one of 18 blocks
  EXPECT_EQ(second_share(features, gate), 188);                  // 128 + 64 * 17 / 18
}

}  // namespace
}  // namespace nightjar::esi
