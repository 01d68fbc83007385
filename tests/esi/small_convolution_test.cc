#include "esi/small_convolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random.h"
#include "esi/edge_mixture.h"
#include "esi/esi_net_weights.h"

namespace nightjar::esi {
namespace {

/// Weights by what they join, and in the order that Convolution takes them in.
struct Kernel {
  Kernel(int channels, int bits, int least_value = 0)
      : in(channels),
        shift(bits),
        least(least_value),
        weights(static_cast<std::size_t>(9 * channels * 16)),
        bias(16) {}

  std::int16_t& at(int row, int column, int from, int to) {
    const int pair = (row * 3 + column) * (in / 2) + from / 2;
    return weights[static_cast<std::size_t>((pair * 16 + to) * 2 + from % 2)];
  }
  Convolution convolution() const { return {in, weights, bias, shift, least}; }

  int in;
  int shift;
  int least;
  std::vector<std::int16_t> weights;
  std::vector<std::int32_t> bias;
};

int between(int least, int greatest, core::Random& random) {
  return least + static_cast<int>(random() % static_cast<std::uint64_t>(greatest - least + 1));
}

Kernel random_kernel(int channels, int shift, int least, core::Random& random) {
  Kernel kernel(channels, shift, least);
  for (std::int16_t& w : kernel.weights) w = static_cast<std::int16_t>(between(-700, 700, random));
  for (std::int32_t& b : kernel.bias) b = between(-2'000'000, 2'000'000, random);
  return kernel;
}

ChannelImage random_image(int width, int height, int channels, core::Random& random) {
  ChannelImage image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < channels; ++k)
        image.at(x, y)[k] = static_cast<std::int16_t>(between(-kMostValue, kMostValue, random));
  return image;
}

/// The definition, in 64 bits.
std::int64_t expected(Kernel& kernel, const ChannelImage& in, int x, int y, int to) {
  std::int64_t sum = kernel.bias[static_cast<std::size_t>(to)];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const int from_x = x + column - 1, from_y = y + row - 1;
      if (from_x < 0 || from_x >= in.width() || from_y < 0 || from_y >= in.height()) continue;
      for (int k = 0; k < in.channels(); ++k)
        sum += std::int64_t{kernel.at(row, column, k, to)} * in.at(from_x, from_y)[k];
    }
  if (kernel.shift > 0) sum += std::int64_t{1} << (kernel.shift - 1);
  return std::clamp<std::int64_t>(sum >> kernel.shift, kernel.least, kMostValue);
}

void expect_as_defined(Kernel& kernel, const ChannelImage& in) {
  for (const ConvolutionVariant& variant : convolution_variants()) {
    ChannelImage out(in.width(), in.height(), kConvolutionOut);
    convolve(variant, kernel.convolution(), in, out);
    for (int y = -1; y <= in.height(); ++y)
      for (int x = -1; x <= in.width(); ++x)
        for (int to = 0; to < kConvolutionOut; ++to) {
          const bool on_rim = x < 0 || y < 0 || x == in.width() || y == in.height();
          ASSERT_EQ(out.at(x, y)[to], on_rim ? 0 : expected(kernel, in, x, y, to))
              << variant.name << ' ' << in.width() << 'x' << in.height() << " at " << x << ", " << y
              << " channel " << to;
        }
  }
}

TEST(SmallConvolution, every_variant_is_as_defined_at_every_width_and_leaves_the_rim_zero) {
  core::Random random = core::random_stream(/*seed=*/1, "test.small_convolution");
  for (int width = 1; width <= 13; ++width)
    for (const int channels : {2, 16, 32})
      for (const int least : {0, -kMostValue}) {
        Kernel kernel = random_kernel(channels, 12, least, random);
        expect_as_defined(kernel, random_image(width, 1 + width % 4, channels, random));
      }
}

TEST(SmallConvolution, one_with_a_single_weight_copies_a_channel_from_a_neighbour) {
  // By hand: output 5 takes twice channel 3 of the pixel to the lower left.
  Kernel kernel(4, 0);
  kernel.at(2, 0, 3, 5) = 2;
  ChannelImage in(3, 2, 4);
  in.at(0, 1)[3] = 70;
  for (const ConvolutionVariant& variant : convolution_variants()) {
    ChannelImage out(3, 2, kConvolutionOut);
    convolve(variant, kernel.convolution(), in, out);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        for (int to = 0; to < kConvolutionOut; ++to)
          EXPECT_EQ(out.at(x, y)[to], x == 1 && y == 0 && to == 5 ? 140 : 0) << variant.name;
  }
}

TEST(SmallConvolution, rounds_halves_upwards_and_keeps_to_its_range) {
  Kernel kernel(2, 3);
  kernel.bias = {-5,
                 -4,
                 -1,
                 0,
                 3,
                 4,
                 11,
                 12,
                 8 * kMostValue + 3,
                 8 * kMostValue + 4,
                 std::numeric_limits<std::int32_t>::max() - 4,
                 std::numeric_limits<std::int32_t>::min(),
                 100'000,
                 32767 * 8,
                 32768 * 8,
                 -32769 * 8};
  const std::int16_t by_hand[] = {0, 0, 0, 0, 0, 1, 1, 2, 8191, 8191, 8191, 0, 8191, 8191, 8191, 0};
  for (const ConvolutionVariant& variant : convolution_variants()) {
    ChannelImage out(1, 1, kConvolutionOut);
    convolve(variant, kernel.convolution(), ChannelImage(1, 1, 2), out);
    for (int to = 0; to < kConvolutionOut; ++to)
      EXPECT_EQ(out.at(0, 0)[to], by_hand[to]) << variant.name << ' ' << to;
  }
}

TEST(SmallConvolution, writes_over_what_was_there) {
  core::Random random = core::random_stream(/*seed=*/2, "test.small_convolution");
  const Kernel kernel = random_kernel(16, 10, 0, random);
  const ChannelImage in = random_image(9, 5, 16, random);
  ChannelImage fresh(9, 5, kConvolutionOut), used = random_image(9, 5, kConvolutionOut, random);
  convolve(kernel.convolution(), in, fresh);
  convolve(kernel.convolution(), in, used);
  for (int y = 0; y < 5; ++y)
    EXPECT_TRUE(std::equal(fresh.at(0, y), fresh.at(9, y), used.at(0, y)));
}

// What EsiNet hands to convolve() must hold for any weights that a training comes up with.
constexpr std::int64_t kMostFeature = 2 * kFeatureOne;  // 2 v / most

std::int64_t most_of(const Convolution& layer, std::int64_t most_value, std::size_t to) {
  std::int64_t most = std::abs(std::int64_t{layer.bias[to]}) + (1 << layer.shift);
  for (std::size_t pair = 0; pair < layer.weights.size() / 32; ++pair)
    for (std::size_t k = 0; k < 2; ++k)
      most += most_value * std::abs(layer.weights[(pair * 16 + to) * 2 + k]);
  return most;
}

void expect_within_32_bits(std::span<const Convolution> layers, std::int64_t most_value) {
  for (const Convolution& layer : layers) {
    // On the way up layers see what has been added to what went down.
    if (layer.least < 0) most_value = 2 * kMostValue;
    ASSERT_EQ(layer.weights.size(), static_cast<std::size_t>(9 * layer.in * kConvolutionOut));
    ASSERT_EQ(layer.bias.size(), static_cast<std::size_t>(kConvolutionOut));
    for (std::size_t to = 0; to < kConvolutionOut; ++to)
      ASSERT_LE(most_of(layer, most_value, to), std::numeric_limits<std::int32_t>::max())
          << "output " << to;
    most_value = kMostValue;
  }
}

TEST(SmallConvolution, no_sum_of_the_edges_can_leave_32_bits_whatever_is_mixed) {
  EdgeMixture mixture;
  for (int second = 0; second <= EdgeMixture::kWhole; ++second) {
    const EdgeWeights& edges = mixture.mix(second);
    expect_within_32_bits(edges.layers, kMostFeature);
    for (std::size_t i = 0; i < kPixelsABlock; ++i) {
      std::int64_t most = std::abs(std::int64_t{edges.output_bias[i]});
      most += std::int64_t{kMostValue} << kEsiNetWeightBits;  // the shade
      for (std::size_t k = 0; k < kEsiNetOutputIn; ++k)
        most += (k < kConvolutionOut ? kMostValue : kMostFeature) *
                std::abs(std::int64_t{edges.output[i * kEsiNetOutputIn + k]});
      ASSERT_LE(most, std::numeric_limits<std::int32_t>::max());
    }
  }
}

TEST(SmallConvolution, no_sum_of_the_shading_can_leave_32_bits) {
  ASSERT_EQ(esi_net_shading().size(), 2 * kShadingLevels - kShadeLevel);
  expect_within_32_bits(esi_net_shading(), kMostValue);
}

}  // namespace
}  // namespace nightjar::esi
