#include "esi/picture_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace nightjar::esi {
namespace {

using Picture = core::Image<std::uint8_t>;

Picture random_picture(core::Resolution size) {
  core::Random random = core::random_stream(/*seed=*/11, "test.picture_filter");
  Picture picture(size);
  for (auto& level : picture.pixels()) level = static_cast<std::uint8_t>(random() % 256);
  return picture;
}

int mirrored(int i, int n) {
  while (n > 1 && (i < 0 || i >= n)) i = i < 0 ? -i : 2 * (n - 1) - i;
  return n == 1 ? 0 : i;
}

/// The weighted mean around a pixel, in doubles; `weight` of dx, dy and the difference in level.
template <class Weight>
Picture weighted(const Picture& in, Weight weight) {
  Picture out(in.size());
  for (int y = 0; y < in.height(); ++y)
    for (int x = 0; x < in.width(); ++x) {
      double sum = 0, weights = 0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const int level = in(mirrored(x + dx, in.width()), mirrored(y + dy, in.height()));
          const double w = weight(dx, dy, level - in(x, y));
          sum += w * level;
          weights += w;
        }
      out(x, y) = static_cast<std::uint8_t>(std::lround(sum / weights));
    }
  return out;
}

void expect_near(const Picture& a, const Picture& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    ASSERT_NEAR(a.pixels()[i], b.pixels()[i], 1) << i;  // floats: on the edge between two levels
}

constexpr core::Resolution kSizes[] = {{1, 1}, {2, 3}, {3, 1}, {17, 12}};

TEST(PictureFilter, GaussianIsTheWeightedMeanOf25) {
  for (const core::Resolution size : kSizes)
    for (const double sigma : {0.3, 1.0, 5.0}) {
      Picture picture = random_picture(size);
      const Picture expected = weighted(picture, [&](int dx, int dy, int) {
        return std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      });
      PictureFilter(SpatialFilter::gaussian, sigma).apply(picture);
      expect_near(picture, expected);
    }
}

TEST(PictureFilter, BilateralWeighsByDistanceAndLevelWithinADisc) {
  for (const core::Resolution size : kSizes)
    for (const double sigma : {0.05, 0.5, 3.0}) {
      Picture picture = random_picture(size);
      const double scale = 20 * sigma;
      const Picture expected = weighted(picture, [&](int dx, int dy, int difference) {
        const int d2 = dx * dx + dy * dy;
        return d2 > 4 ? 0.0 : std::exp(-(d2 + 1.0 * difference * difference) / (2 * scale * scale));
      });
      PictureFilter(SpatialFilter::bilateral, sigma).apply(picture);
      expect_near(picture, expected);
    }
}

TEST(PictureFilter, HandWorkedGaussianOfOnePoint) {
  // sigma 1: weights exp(-d^2/2) are 1, 0.6065, 0.1353, sum 2.4838; the middle keeps
  // (1/2.4838)^2 = 0.1621, 1 and 2 beside it 0.0983 and 0.0219.
  Picture picture({9, 9});
  picture(4, 4) = 200;
  PictureFilter(SpatialFilter::gaussian, 1.0).apply(picture);
  EXPECT_EQ(picture(4, 4), 32);
  EXPECT_EQ(picture(5, 4), 20);
  EXPECT_EQ(picture(4, 6), 4);
  EXPECT_EQ(picture(4, 7), 0);
}

TEST(PictureFilter, BilateralKeepsAnEdgeThatGaussianBlurs) {
  Picture edge({12, 6});
  for (int y = 0; y < 6; ++y)
    for (int x = 6; x < 12; ++x) edge(x, y) = 250;
  Picture bilateral = edge, gaussian = edge;
  PictureFilter(SpatialFilter::bilateral, 1.0).apply(bilateral);
  PictureFilter(SpatialFilter::gaussian, 1.0).apply(gaussian);
  EXPECT_EQ(bilateral, edge);  // exp(-250^2 / (2 20^2)) is nothing
  EXPECT_GT(gaussian(5, 3), 40);
}

TEST(PictureFilter, ItsPicturesMayChangeSizeAndNoneLeavesThemAlone) {
  PictureFilter filter(SpatialFilter::gaussian, 1.0);
  Picture small({4, 4}, 90), large({20, 10}, 90);
  filter.apply(small);
  filter.apply(large);
  EXPECT_EQ(small, Picture({4, 4}, 90));
  EXPECT_EQ(large, Picture({20, 10}, 90));
  Picture random = random_picture({9, 7});
  PictureFilter(SpatialFilter::none, 1.0).apply(random);
  EXPECT_EQ(random, random_picture({9, 7}));
}

}  // namespace
}  // namespace nightjar::esi
