#include "esi/block_output.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr int kHidden = 16;
constexpr float kLevels = 45.0f / (512 << 12);

void expect_own_weights(int feature_count, core::Resolution size, core::Random& random) {
  const auto values = static_cast<std::size_t>(kHidden + feature_count);
  std::vector<std::int16_t> weights(4 * values);
  std::array<std::int32_t, 4> bias;
  for (auto& w : weights) w = static_cast<std::int16_t>(random() % 2001 - 1000);
  for (auto& b : bias) b = static_cast<std::int32_t>(random() % 2'000'001 - 1'000'000);
  BlockOutput output(kLevels);
  output.set_weights(weights, bias);
  ChannelImage hidden((size.width_px + 1) / 2, (size.height_px + 1) / 2, kHidden);
  ChannelImage features(hidden.width(), hidden.height(), feature_count);
  for (ChannelImage* image : {&hidden, &features})
    for (int y = 0; y < image->height(); ++y)
      for (int i = 0; i < image->width() * image->channels(); ++i)
        image->at(0, y)[i] = static_cast<std::int16_t>(random() % (kMostValue / 2));
  core::Image<std::int32_t> shade({hidden.width(), hidden.height()});
  for (std::int32_t& s : shade.pixels())
    s = static_cast<std::int32_t>(random() % 4'000'001) - 2'000'000;
  core::Image<std::uint8_t> gray(size);
  output.write(hidden, features, shade, gray);
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x) {
      const auto i = static_cast<std::size_t>(y % 2 * 2 + x % 2);
      double sum = bias[i] + shade(x / 2, y / 2);
      for (std::size_t k = 0; k < values; ++k)
        sum += weights[i * values + k] *
               (k < kHidden ? hidden.at(x / 2, y / 2)[k] : features.at(x / 2, y / 2)[k - kHidden]);
      const double level = std::clamp(127.5 + double{kLevels} * sum, 0.0, 255.0);
      // Rounded to the nearest; floats of some 1e2 are right to 2e-5.
      ASSERT_NEAR(gray(x, y), level, 0.5 + 1e-4) << x << ", " << y;
    }
}

TEST(BlockOutput, gives_each_pixel_of_a_block_its_own_weights_at_even_and_odd_sizes) {
  core::Random random = core::random_stream(/*seed=*/1, "test.block_output");
  for (const core::Resolution size :
       {core::Resolution{1, 1}, {2, 2}, {5, 4}, {4, 5}, {13, 7}, {346, 2}, {347, 3}})
    for (const int feature_count : {6, 32})  // two blocks at once take eight values at a time
      expect_own_weights(feature_count, size, random);
}

TEST(BlockOutput, keeps_to_8_bits) {
  // Two hidden values and two features for each of the four pixels.
  const std::array<std::int16_t, 16> weights{1000,  0, 0, 0, 0, 1000, 0, 0,
                                             -1000, 0, 0, 0, 0, 0,    0, 0};
  const std::array<std::int32_t, 4> bias{0, 0, 0, 100};
  BlockOutput output(1.0f);
  output.set_weights(weights, bias);
  ChannelImage hidden(1, 1, 2);
  const ChannelImage features(1, 1, 2);
  hidden.at(0, 0)[0] = kMostValue;
  core::Image<std::uint8_t> gray({2, 2});
  output.write(hidden, features, core::Image<std::int32_t>({1, 1}), gray);
  EXPECT_EQ(gray(0, 0), 255);
  EXPECT_EQ(gray(1, 0), 128);  // 127.5, rounded
  EXPECT_EQ(gray(0, 1), 0);
  EXPECT_EQ(gray(1, 1), 228);
}

}  // namespace
}  // namespace nightjar::esi
