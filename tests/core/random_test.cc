#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nightjar::core {
namespace {

constexpr int kDraws = 100000;

TEST(Random, SameSeedAndNameRepeatTheStream) {
  Random a = random_stream(7, "shot"), b = random_stream(7, "shot");
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a(), b());
}

TEST(Random, AnotherSeedOrNameIsAnotherStream) {
  EXPECT_NE(random_stream(7, "shot")(), random_stream(8, "shot")());
  EXPECT_NE(random_stream(7, "shot")(), random_stream(7, "leak")());
}

TEST(Random, FirstNumbersAreFixedForAllTimes) {
  // Results of the past stay comparable only while these hold.
  Random random = random_stream(1, "golden");
  EXPECT_EQ(random(), 17457847671254467723ULL);
  EXPECT_EQ(random(), 6862446941076381612ULL);
}

TEST(Random, UniformHasItsMeanAndRange) {
  Random random = random_stream(3, "uniform");
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = uniform01(random);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
  }
  // 5 sigma of the mean of n uniforms: 5 / sqrt(12 n).
  EXPECT_NEAR(sum / kDraws, 0.5, 5 / std::sqrt(12.0 * kDraws));
}

TEST(Random, NormalHasMeanZeroAndVarianceOne) {
  Random random = random_stream(3, "normal");
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = normal(random);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 5 / std::sqrt(1.0 * kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0, 5 * std::sqrt(2.0 / kDraws));  // variance of a chi-square
}

TEST(Random, SuccessiveNormalsAreUncorrelated) {
  Random random = random_stream(3, "normal");
  double products = 0, square_products = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double a = normal(random), b = normal(random);
    products += a * b;
    square_products += (a * a - 1) * (b * b - 1);
  }
  // 5 sigma of means whose terms have the variances 1 and 4.
  EXPECT_NEAR(products / kDraws, 0.0, 5 / std::sqrt(1.0 * kDraws));
  EXPECT_NEAR(square_products / kDraws, 0.0, 5 * 2 / std::sqrt(1.0 * kDraws));
}

TEST(Random, ExponentialHasMeanOne) {
  Random random = random_stream(3, "exponential");
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) sum += exponential(random);
  EXPECT_NEAR(sum / kDraws, 1.0, 5 / std::sqrt(1.0 * kDraws));
}

}  // namespace
}  // namespace nightjar::core
