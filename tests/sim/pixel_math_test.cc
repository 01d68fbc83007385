#include "sim/pixel_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random.h"

namespace nightjar::sim {
namespace {

TEST(PixelMath, logarithm_is_good_to_single_precision) {
  for (double x = 1e-3; x < 1e6; x *= 1.0007) {
    const auto value = static_cast<float>(x);
    const double truth = std::log(static_cast<double>(value));
    // 2 ulp of a float, absolute near the zero at 1.
    const double tolerance = 2.4e-7 * std::max(1.0, std::abs(truth));
    EXPECT_NEAR(fast_log<Fused>(value), truth, tolerance) << x;
    EXPECT_NEAR(fast_log<Apart>(value), truth, tolerance) << x;
  }
}

TEST(PixelMath, square_root_is_good_to_five_millionths) {
  for (double x = 1e-30; x < 1e30; x *= 1.003) {
    const double truth = std::sqrt(static_cast<double>(static_cast<float>(x)));
    EXPECT_NEAR(fast_sqrt(static_cast<float>(x)), truth, 5e-6 * truth) << x;
  }
  EXPECT_EQ(fast_sqrt(0.0f), 0.0f);
}

TEST(PixelMath, normal_pair_is_what_box_and_muller_say) {
  core::Random random = core::random_stream(4, "normal_pair");
  constexpr double kPi = std::numbers::pi;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    const auto low = static_cast<std::uint32_t>(bits);
    // Among them the smallest radii there are.
    const auto high =
        i < 1000 ? ~static_cast<std::uint32_t>(i) : static_cast<std::uint32_t>(bits >> 32);
    const double radius = std::sqrt(-2 * std::log((std::floor(high / 2.0) + 0.5) * 0x1p-31));
    const double angle = static_cast<std::int32_t>(low << 2) * kPi * 0x1p-33;
    const double quarter = low & 0x40000000u ? std::sin(angle) : std::cos(angle);
    const double other = low & 0x40000000u ? std::cos(angle) : std::sin(angle);
    const double cosine_sign = low & 0x80000000u ? -1 : 1;
    const auto [first, second] = fast_normal_pair(high, low);
    // The root's 5e-6, and what rounding u to 24 bits does to a small radius: the square is off by
    // up to 2^-23, or 2^-24 near u = 1, where all up to sqrt(2^-24) = 2.4e-4 becomes 0.
    const double tolerance = 5e-6 * radius + std::min(0x1p-24 / radius, 3e-4);
    EXPECT_NEAR(first, radius * quarter * (low & 0x40000000u ? 1 : cosine_sign), tolerance);
    EXPECT_NEAR(second, radius * other * (low & 0x40000000u ? cosine_sign : 1), tolerance);
  }
}

/// Counts of 2 n deviates from -6 to 6 in steps of 1/4, first and last with all beyond.
std::array<double, 48> normal_histogram(std::uint64_t seed, int n) {
  core::Random random = core::random_stream(seed, "normal_pair");
  std::array<double, 48> counts{};
  const auto add = [&](float x) { ++counts[std::clamp(static_cast<int>(4 * x + 24), 0, 47)]; };
  for (int i = 0; i < n; ++i) {
    const std::uint64_t bits = random();
    const auto [first, second] =
        fast_normal_pair(static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits));
    add(first);
    add(second);
  }
  return counts;
}

TEST(PixelMath, normal_pair_is_normal_far_into_its_tails) {
  constexpr int kPairs = 5'000'000;
  const std::array<double, 48> counts = normal_histogram(5, kPairs);
  const auto below = [](double x) { return std::erfc(-x / std::numbers::sqrt2) / 2; };
  for (int i = 0; i < 48; ++i) {
    const double from = i == 0 ? 0 : below(i / 4.0 - 6),
                 to = i == 47 ? 1 : below((i + 1) / 4.0 - 6);
    const double expected = 2 * kPairs * (to - from);
    // 5 deviations of Poisson; where few are expected, 5 more.
    EXPECT_NEAR(counts[i], expected, 5 * std::sqrt(expected) + 5) << i / 4.0 - 6;
  }
  EXPECT_GT(counts[4] + counts[43], 0);  // beyond 4.75 deviations: 20 of ten million
  EXPECT_NEAR(fast_normal_pair(0, 0).first, 6.66, 0.01);
}

TEST(PixelMath, both_of_a_normal_pair_are_independent) {
  constexpr int kPairs = 1'000'000;
  core::Random random = core::random_stream(6, "normal_pair");
  double product = 0, squares = 0, signs = 0;
  for (int i = 0; i < kPairs; ++i) {
    const std::uint64_t bits = random();
    const auto [a, b] =
        fast_normal_pair(static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits));
    product += double{a} * b;
    squares += (double{a} * a - 1) * (double{b} * b - 1) / 2;
    signs += (a < 0) == (b < 0) ? 1 : -1;
  }
  for (const double sum : {product, squares, signs})  // each term has the deviation 1
    EXPECT_NEAR(sum, 0, 5 * std::sqrt(kPairs));
}

TEST(PixelMath, one_minus_exp_keeps_its_relative_precision_down_to_nothing) {
  for (double a = 1e-9; a < 80; a *= 1.003) {
    const auto value = static_cast<float>(a);
    const double truth = -std::expm1(-static_cast<double>(value));
    EXPECT_NEAR(fast_one_minus_exp(value), truth, 2.4e-7 * truth) << a;  // 2 ulp
  }
  EXPECT_EQ(fast_one_minus_exp(0.0f), 0.0f);
}

TEST(PixelMath, mean_of_an_exponential_is_good_to_single_precision) {
  for (double a = 1e-9; a <= 1; a *= 1.003) {
    const auto value = static_cast<float>(a);
    const double truth = -std::expm1(-static_cast<double>(value)) / static_cast<double>(value);
    EXPECT_NEAR(fast_mean_exp(value), truth, 2.4e-7 * truth) << a;  // 2 ulp
  }
}

TEST(PixelMath, logarithmic_mean_comes_without_a_division) {
  for (double d = -1; d <= 1; d += 0.01) {
    const double a = 100, b = a * std::exp(d), mean = (a + b) / 2;
    const double truth = mean - (std::abs(d) < 1e-6 ? mean : (b - a) / d);
    // 4e-6 of the polynomial, the rest single precision.
    EXPECT_NEAR(log_mean_deficit(static_cast<float>(b - a), static_cast<float>(d)), truth,
                4.2e-6 * mean)
        << d;
  }
}

TEST(PixelMath, exponential_is_good_to_double_precision) {
  for (double a = 1e-9; a < 700; a *= 1.003) {
    const double truth = std::exp(-a);
    // The series stops at 7e-15; the reduction by a multiple of ln 2 is exact to 1e-16 a.
    EXPECT_NEAR(fast_exp_minus(a), truth, (1e-14 + 1e-16 * a) * truth) << a;
  }
  for (double a = -700; a < 0; a += 0.37)
    EXPECT_NEAR(fast_exp_minus(a), std::exp(-a), (1e-14 - 1e-16 * a) * std::exp(-a)) << a;
  EXPECT_EQ(fast_exp_minus(0), 1);
  EXPECT_LT(fast_exp_minus(1e9), 1e-300);
}

}  // namespace
}  // namespace nightjar::sim
