#include "esi/fast_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace nightjar::esi {
namespace {

TEST(FastMath, Exp2KeepsItsErrorBound) {
  double worst = 0;
  for (double at = -126; at <= 126; at += 0.000917) {
    const auto x = static_cast<float>(at);
    worst = std::max(worst, std::abs(fast_exp2(x) / std::exp2(static_cast<double>(x)) - 1));
  }
  EXPECT_LT(worst, 1.5e-7);  // as the header says; half a float's last digit is 6e-8
}

TEST(FastMath, Exp2IsExactWhereABiasWouldAddUp) {
  EXPECT_EQ(fast_exp2(0.0f), 1.0f);
  EXPECT_EQ(fast_exp2(-0.0f), 1.0f);
  EXPECT_EQ(fast_exp2(-3.0f), 0.125f);
}

TEST(FastMath, Exp2StaysFiniteAndEndsInZero) {
  EXPECT_EQ(fast_exp2(-126.6f), 0.0f);
  EXPECT_EQ(fast_exp2(-1e30f), 0.0f);
  EXPECT_EQ(fast_exp2(200.0f), std::exp2(126.0f));
}

TEST(FastMath, Log2KeepsItsErrorBound) {
  for (double x = 1e-300; x < 1e300; x *= 1.0173) {
    const double expected = std::log2(x);
    // As the header says: a polynomial off by 1e-7, then a float's rounding.
    ASSERT_NEAR(fast_log2(x), expected, 4e-7 + 1e-7 * std::abs(expected)) << x;
  }
  EXPECT_EQ(fast_log2(1.0), 0.0f);
  EXPECT_EQ(fast_log2(8.0), 3.0f);
}

TEST(FastMath, UnsignedNumbersBeyondASignedOneConvertToo) {
  for (const std::uint32_t value : {0u, 1u, 65535u, 65536u, 2147483647u, 2147483648u, 4294967295u})
    // Two roundings of a 24 bit mantissa.
    EXPECT_NEAR(to_float(value), static_cast<double>(value), 1.2e-7 * value) << value;
}

TEST(FastMath, GreyLevelsAreRoundedAndBounded) {
  EXPECT_EQ(to_gray(-1e30f), 0);
  EXPECT_EQ(to_gray(0.49f), 0);
  EXPECT_EQ(to_gray(0.51f), 1);
  EXPECT_EQ(to_gray(254.6f), 255);
  EXPECT_EQ(to_gray(1e30f), 255);
}

}  // namespace
}  // namespace nightjar::esi
