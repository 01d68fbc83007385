#include "esi/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr core::Resolution kSize{32, 24};

/// Smooth waves of the whole range.
core::Image<std::uint8_t> waves() {
  core::Image<std::uint8_t> image(kSize);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x)
      image(x, y) = static_cast<std::uint8_t>(
          std::lround(127.5 + 60 * std::sin(0.4 * x) + 60 * std::cos(0.3 * y)));
  return image;
}

template <class Change>
core::Image<std::uint8_t> changed(core::Image<std::uint8_t> image, Change change) {
  for (std::uint8_t& value : image.pixels()) value = static_cast<std::uint8_t>(change(value));
  return image;
}

core::Image<std::uint8_t> noisy(const core::Image<std::uint8_t>& image, double deviation) {
  core::Random random = core::random_stream(/*seed=*/5, "test.quality");
  return changed(image, [&](int value) {
    return std::clamp(std::lround(value + deviation * core::normal(random)), 0L, 255L);
  });
}

TEST(QualityTest, finds_a_picture_equal_to_itself) {
  const Quality quality = compare(waves(), waves());
  EXPECT_NEAR(quality.gain, 1, 1e-12);  // rounding of doubles
  EXPECT_NEAR(quality.mse, 0, 1e-20);
  EXPECT_GT(quality.psnr_db, 200);
  EXPECT_NEAR(quality.ssim, 1, 1e-9);
}

TEST(QualityTest, does_not_mind_another_brightness_and_contrast) {
  // Every value of 2 v' + 10 is exact, so only doubles round.
  const auto dull = changed(waves(), [](int value) { return value / 4; });
  const auto bright = changed(dull, [](int value) { return 2 * value + 10; });
  const Quality quality = compare(dull, bright);
  EXPECT_NEAR(quality.gain, 2, 1e-9);
  EXPECT_NEAR(quality.offset_levels, 10, 1e-9);
  EXPECT_NEAR(quality.mse, 0, 1e-15);
  EXPECT_NEAR(quality.ssim, 1, 1e-9);
}

TEST(QualityTest, tells_the_error_left_after_the_fit) {
  // Half the pixels at 100, half at 200, of each half again half 10 more and half 10 less:
  // the best line is the identity and what is left is 10 levels everywhere.
  core::Image<std::uint8_t> picture(kSize), reference(kSize);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x) {
      const int level = x % 2 == 0 ? 100 : 200;
      picture(x, y) = static_cast<std::uint8_t>(level);
      reference(x, y) = static_cast<std::uint8_t>(level + (y % 2 == 0 ? 10 : -10));
    }
  const Quality quality = compare(picture, reference);
  EXPECT_NEAR(quality.gain, 1, 1e-12);
  EXPECT_NEAR(quality.mse, 100, 1e-9);
  EXPECT_NEAR(quality.psnr_db, 10 * std::log10(255.0 * 255.0 / 100), 1e-9);
}

TEST(QualityTest, takes_a_flat_picture_for_its_mean) {
  const Quality quality = compare(core::Image<std::uint8_t>(kSize, 7), waves());
  EXPECT_EQ(quality.gain, 0);
  EXPECT_GT(quality.mse, 1000);  // the waves' variance, 2 * 60^2 / 2
  EXPECT_LT(quality.ssim, 0.1);
  const Quality flat =
      compare(core::Image<std::uint8_t>(kSize, 7), core::Image<std::uint8_t>(kSize, 90));
  EXPECT_EQ(flat.mse, 0);
  EXPECT_EQ(flat.psnr_db, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(flat.ssim, 1, 1e-12);
}

TEST(QualityTest, does_not_take_a_negative_for_the_picture) {
  const Quality quality = compare(changed(waves(), [](int value) { return 255 - value; }), waves());
  EXPECT_EQ(quality.gain, 0);
  EXPECT_LT(quality.ssim, 0.1);
}

TEST(QualityTest, falls_with_noise) {
  const Quality little = compare(noisy(waves(), 5), waves());
  const Quality much = compare(noisy(waves(), 40), waves());
  EXPECT_GT(little.ssim, much.ssim + 0.2);
  EXPECT_GT(little.psnr_db, much.psnr_db + 10);
  // The mean of 768 squares of deviation 5 scatters by sqrt(2 / 768); 5 sigma is 25 %.
  EXPECT_NEAR(little.mse, 25, 0.25 * 25 + 1.0 / 12);
}

TEST(QualityTest, agrees_with_ssim_worked_out_pixel_by_pixel) {
  // One window's worth: Wang et al. 2004, eq. 13, written out.
  core::Image<std::uint8_t> a({11, 11}), b({11, 11});
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x) {
      a(x, y) = static_cast<std::uint8_t>((37 * x + 11 * y) % 200);
      b(x, y) = static_cast<std::uint8_t>((29 * x + 17 * y + 5) % 180 + 20);
    }
  const Quality quality = compare(a, b);
  double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x) {
      const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
      const double va = quality.gain * a(x, y) + quality.offset_levels, vb = b(x, y);
      weights += w;
      ma += w * va;
      mb += w * vb;
      aa += w * va * va;
      bb += w * vb * vb;
      ab += w * va * vb;
    }
  ma /= weights, mb /= weights, aa /= weights, bb /= weights, ab /= weights;
  const double c1 = 2.55 * 2.55, c2 = 7.65 * 7.65;
  const double wanted = (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
                        ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
  EXPECT_NEAR(quality.ssim, wanted, 1e-9);  // rounding of doubles
}

TEST(QualityTest, refuses_pictures_it_cannot_compare) {
  const auto message = [](core::Resolution a, core::Resolution b) {
    try {
      compare(core::Image<std::uint8_t>(a), core::Image<std::uint8_t>(b));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({12, 11}, {11, 12}), "picture of 12x11 px, allowed 11x12 as the reference has");
  EXPECT_EQ(message({10, 40}, {10, 40}), "picture of 10x40 px, allowed from 11x11 on");
}

}  // namespace
}  // namespace nightjar::esi
