#include "core/lens.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nightjar::core {
namespace {

const Lens kBarrel{-0.3, 0.1, 0.002, -0.001, -0.02};
const Lens kPincushion{0.2, 0.05, -0.001, 0.003, 0.01};

TEST(LensTest, an_ideal_lens_moves_nothing) {
  EXPECT_TRUE(Lens{}.is_ideal());
  EXPECT_FALSE(kBarrel.is_ideal());
  EXPECT_EQ(*Lens{}.distort({0.3, -0.2}), Eigen::Vector2d(0.3, -0.2));
  EXPECT_EQ(*Lens{}.undistort({0.3, -0.2}), Eigen::Vector2d(0.3, -0.2));
}

TEST(LensTest, follows_the_formula_of_its_header) {
  // x = 0.5, y = 0.25: r^2 = 0.3125, 2 x y = 0.25, worked out term by term.
  const double radial = 1 + 0.2 * 0.3125 + 0.05 * 0.09765625 + 0.01 * 0.030517578125;
  const auto seen = kPincushion.distort({0.5, 0.25});
  ASSERT_TRUE(seen);
  EXPECT_DOUBLE_EQ(seen->x(), 0.5 * radial - 0.001 * 0.25 + 0.003 * (0.3125 + 0.5));
  EXPECT_DOUBLE_EQ(seen->y(), 0.25 * radial - 0.001 * (0.3125 + 0.125) + 0.003 * 0.25);
}

TEST(LensTest, undistorting_is_the_inverse_wherever_the_lens_shows_something) {
  for (const Lens& lens : {kBarrel, kPincushion})
    for (double x = -0.8; x <= 0.8; x += 0.1)
      for (double y = -0.6; y <= 0.6; y += 0.1) {
        const auto seen = lens.distort({x, y});
        ASSERT_TRUE(seen) << x << ' ' << y;
        const auto back = lens.undistort(*seen);
        ASSERT_TRUE(back) << x << ' ' << y;
        // The promised 1e-12, and the least slope of these two lenses, 0.3 along a radius.
        EXPECT_LT((*back - Eigen::Vector2d(x, y)).norm(), 1e-11);
      }
}

TEST(LensTest, undistorts_what_a_lens_shows_that_first_stretches_and_then_turns_back) {
  // Its slope 1 + 0.21 s + 0.95 s^2 - 0.91 s^3 of s = r^2 is 0 at r = 1.272, which is seen at 2.03:
  // most seen points lie beyond the radius up to which there is anything.
  const Lens stretching{0.07, 0.19, 0, 0, -0.13}, decentred{0.07, 0.19, 0.002, -0.001, -0.13};
  for (const Lens& lens : {stretching, decentred})
    for (double r = 0; r <= 1.24; r += 0.01)
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector2d p(r * std::cos(0.8 * i), r * std::sin(0.8 * i));
        const auto seen = lens.distort(p);
        ASSERT_TRUE(seen) << p.transpose();
        const auto back = lens.undistort(*seen);
        ASSERT_TRUE(back) << p.transpose();
        // The promised 1e-12 and the least slope on the way, 0.2 at r = 1.24.
        EXPECT_LT((*back - p).norm(), 1e-11) << p.transpose();
      }
  EXPECT_FALSE(stretching.undistort({2.1, 0}));
}

TEST(LensTest, shows_nothing_beyond_the_radius_where_it_turns_back) {
  const Lens lens{-0.5, 0, 0, 0, 0};  // r - r^3 / 2 turns at r = sqrt(2/3), seen at 2/3 of that
  const double turn = std::sqrt(2.0 / 3);
  EXPECT_TRUE(lens.distort({0.999 * turn, 0}));
  EXPECT_FALSE(lens.distort({1.001 * turn, 0}));
  EXPECT_TRUE(lens.undistort({0.999 * turn * 2 / 3, 0}));
  EXPECT_FALSE(lens.undistort({1.001 * turn * 2 / 3, 0}));
}

TEST(LensTest, stays_blind_where_a_higher_power_turns_it_forward_again) {
  // Slopes 1 - 3 s + 2 s^2 and (1 - s)(1 - 2 s)(1 - 3 s) of s = r^2.
  const Lens two{-1, 0.4, 0, 0, 0}, three{-2, 11.0 / 5, 0, 0, -6.0 / 7};
  EXPECT_TRUE(two.distort({std::sqrt(0.49), 0}));
  EXPECT_FALSE(two.distort({std::sqrt(0.75), 0}));
  EXPECT_FALSE(two.distort({std::sqrt(1.5), 0}));
  EXPECT_TRUE(three.distort({std::sqrt(0.33), 0}));
  EXPECT_FALSE(three.distort({std::sqrt(0.4), 0}));
  EXPECT_FALSE(three.distort({std::sqrt(0.7), 0}));
}

TEST(LensTest, points_that_are_no_numbers_are_seen_nowhere) {
  EXPECT_FALSE(kBarrel.distort({std::nan(""), 0}));
  EXPECT_FALSE(kBarrel.undistort({0, std::nan("")}));
}

}  // namespace
}  // namespace nightjar::core
