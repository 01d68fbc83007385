#include "esi/sharpness.h"

#include <gtest/gtest.h>

namespace nightjar::esi {
namespace {

constexpr core::Resolution kSize{20, 6};
const core::Image<float> kMoving(kSize, 0.0f);
constexpr SharpnessRows kAll{1};

/// A rise from 0 to 1 over so many pixels.
core::Image<float> rise(int width_px) {
  core::Image<float> picture(kSize);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x)
      picture(x, y) =
          std::clamp(static_cast<float>(x - 5) / static_cast<float>(width_px), 0.f, 1.f);
  return picture;
}

TEST(Sharpness, HandWorkedEdges) {
  // Rows 0, 2, 4 against their right neighbours: n differences of 1/n each, so n/n^2 over 1,
  // and three rows: 3 (1/n) / 9.
  EXPECT_NEAR(sharpness(rise(1), kMoving, kAll), 1.0 / 3, 1e-6);  // floats
  EXPECT_NEAR(sharpness(rise(4), kMoving, kAll), 1.0 / 12, 1e-6);
}

TEST(Sharpness, FallsWhenAnEdgeIsOverdone) {
  core::Image<float> overdone = rise(1);
  for (int y = 0; y < kSize.height_px; ++y) overdone(5, y) = -0.2f;
  EXPECT_LT(sharpness(overdone, kMoving, kAll), sharpness(rise(1), kMoving, kAll));
}

TEST(Sharpness, IgnoresScaleAndWhatIsStill) {
  core::Image<float> twice = rise(3);
  for (float& value : twice.pixels()) value *= 2;
  EXPECT_NEAR(sharpness(twice, kMoving, kAll), sharpness(rise(3), kMoving, kAll), 1e-6);  // floats
  core::Image<float> still(kSize, 1.0f);
  EXPECT_EQ(sharpness(rise(3), still, kAll), 0.0);
  still(5, 2) = 0;  // 4-5 and 5-6 are looked at; only 5-6 differ
  EXPECT_NEAR(sharpness(rise(3), still, kAll), 1.0, 1e-6);
}

TEST(Sharpness, LooksAtChosenRowsAndTheirNeighboursOnly) {
  core::Image<float> picture({4, 8});
  picture(1, 2) = picture(1, 6) = 1;
  EXPECT_EQ(sharpness(picture, core::Image<float>({4, 8}), SharpnessRows{2}), 0.0);
  picture(1, 5) = 1;
  EXPECT_GT(sharpness(picture, core::Image<float>({4, 8}), SharpnessRows{2}), 0.0);
  for (int y = 0; y < 8; ++y) EXPECT_EQ(SharpnessRows{2}.takes(y), y < 2 || y == 4 || y == 5);
  EXPECT_EQ(SharpnessRows::of(2).step, 1);
  EXPECT_EQ(SharpnessRows::of(260).step, 5);  // 26 rows of 130 pairs
}

TEST(FirstMaximum, FindsTheLowestOfSeveral) {
  const auto value = [](double x) {
    return 1 / (1 + 100 * (x - 0.2) * (x - 0.2)) + 3 / (1 + 3000 * (x - 0.45) * (x - 0.45));
  };
  const auto place = first_maximum(0.05, 0.5, value);
  ASSERT_TRUE(place);
  EXPECT_NEAR(*place, 0.2, 0.02 * 0.2 + 0.003);  // as promised; the second peak shifts the first
}

TEST(FirstMaximum, IsNoneWhereThereIsOnlyARiseOrAFall) {
  EXPECT_FALSE(first_maximum(0.05, 0.5, [](double x) { return x; }));
  EXPECT_FALSE(first_maximum(0.05, 0.5, [](double x) { return -x; }));
  EXPECT_FALSE(first_maximum(0.05, 0.5, [](double) { return 1.0; }));
}

}  // namespace
}  // namespace nightjar::esi
