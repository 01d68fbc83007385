#include "esi/channel_scaling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr int kChannels = 16;

ChannelImage random_image(int width, int height, core::Random& random) {
  ChannelImage image(width, height, kChannels);
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < width * kChannels; ++i)
      image.at(0, y)[i] =
          static_cast<std::int16_t>(static_cast<int>(random() % 16383) - kMostValue);
  return image;
}

/// Zeros, as convolve() wants them around a picture.
void expect_empty_rim(const ChannelImage& image) {
  const auto is_empty = [&](int x, int y) {
    return std::all_of(image.at(x, y), image.at(x, y) + kChannels, [](int v) { return v == 0; });
  };
  for (int x = -1; x <= image.width(); ++x)
    EXPECT_TRUE(is_empty(x, -1) && is_empty(x, image.height())) << "column " << x;
  for (int y = -1; y <= image.height(); ++y)
    EXPECT_TRUE(is_empty(-1, y) && is_empty(image.width(), y)) << "row " << y;
}

TEST(ChannelScaling, halving_takes_means_as_by_hand) {
  ChannelImage in(3, 2, 1), out(2, 1, 1);
  const std::int16_t values[2][3] = {{1, 2, 100}, {3, 5, 201}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) *in.at(x, y) = values[y][x];
  halve(in, out);
  EXPECT_EQ(*out.at(0, 0), 3);    // 11 / 4 = 2.75
  EXPECT_EQ(*out.at(1, 0), 151);  // 150.5: the last column counts twice, halves go up
}

TEST(ChannelScaling, halving_is_the_mean_at_every_size) {
  core::Random random = core::random_stream(/*seed=*/1, "test.channel_scaling");
  for (int width = 1; width <= 6; ++width)
    for (int height = 1; height <= 6; ++height) {
      const ChannelImage in = random_image(width, height, random);
      ChannelImage out(halved(width), halved(height), kChannels);
      halve(in, out);
      expect_empty_rim(out);
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
          for (int k = 0; k < kChannels; ++k) {
            double sum = 0;
            for (int n = 0; n < 4; ++n)
              sum +=
                  in.at(std::min(2 * x + n % 2, width - 1), std::min(2 * y + n / 2, height - 1))[k];
            ASSERT_EQ(out.at(x, y)[k], std::floor(sum / 4 + 0.5)) << width << 'x' << height;
          }
    }
}

TEST(ChannelScaling, halving_leaves_the_other_channels) {
  core::Random random = core::random_stream(/*seed=*/3, "test.channel_scaling");
  const ChannelImage in = random_image(5, 3, random);
  ChannelImage alone(3, 2, kChannels), both(3, 2, 2 * kChannels);
  halve(in, alone);
  halve(in, both, kChannels);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      for (int k = 0; k < kChannels; ++k) {
        ASSERT_EQ(both.at(x, y)[k], 0);
        ASSERT_EQ(both.at(x, y)[kChannels + k], alone.at(x, y)[k]);
      }
}

TEST(ChannelScaling, doubling_adds_to_each_pixel_what_halving_makes_of_it) {
  core::Random random = core::random_stream(/*seed=*/2, "test.channel_scaling");
  for (int width = 1; width <= 6; ++width)
    for (int height = 1; height <= 6; ++height) {
      const ChannelImage in = random_image(halved(width), halved(height), random);
      const ChannelImage before = random_image(width, height, random);
      ChannelImage out = before;
      add_doubled(in, out);
      expect_empty_rim(out);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int k = 0; k < kChannels; ++k)
            ASSERT_EQ(out.at(x, y)[k], before.at(x, y)[k] + in.at(x / 2, y / 2)[k]);
    }
}

TEST(ChannelScaling, smooth_doubling_is_as_by_hand_and_goes_on_beyond_the_edges) {
  core::Image<std::int32_t> in({2, 1}), out({3, 2});
  in(0, 0) = 0;
  in(1, 0) = 160;
  double_smoothly(in, out);
  for (int y = 0; y < 2; ++y) {
    EXPECT_EQ(out(0, y), 0);
    EXPECT_EQ(out(1, y), 40);  // three quarters of the nearer one, a quarter of the other
    EXPECT_EQ(out(2, y), 120);
  }
  in(1, 0) = 3;
  double_smoothly(in, out);
  EXPECT_EQ(out(1, 0), 1);  // 0.75, rounded
  EXPECT_EQ(out(2, 0), 2);  // 2.25
}

TEST(ChannelScaling, smooth_doubling_keeps_a_slope) {
  // f(x, y) = 32 x - 48 y at the middles of the pixels, so that every quarter is whole.
  core::Image<std::int32_t> in({6, 5}), out({12, 10});
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) in(x, y) = 32 * (2 * x + 1) - 48 * (2 * y + 1);
  double_smoothly(in, out);
  for (int y = 1; y < 9; ++y)
    for (int x = 1; x < 11; ++x)
      EXPECT_EQ(out(x, y), 16 * (2 * x + 1) - 24 * (2 * y + 1)) << x << ", " << y;
}

}  // namespace
}  // namespace nightjar::esi
