#include "scenarios/latency_histogram.h"

#include <gtest/gtest.h>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

TEST(LatencyHistogram, QuantilesAreNeverTooShortAndAtMostTwoPercentTooLong) {
  LatencyHistogram histogram;
  for (int us = 1; us <= 100'000; ++us) histogram.add(core::Time(us));
  EXPECT_EQ(histogram.count(), 100'000u);
  for (const double share : {0.001, 0.5, 0.99, 1.0}) {
    const auto exact_us = static_cast<std::int64_t>(100'000 * share);
    EXPECT_GE(histogram.quantile(share).count(), exact_us) << share;
    EXPECT_LE(histogram.quantile(share).count(), exact_us * 102 / 100 + 1) << share;
  }
  EXPECT_EQ(histogram.greatest(), 100'000us);
}

TEST(LatencyHistogram, OneSlowStepInAHundredIsBeyondThe99Percent) {
  LatencyHistogram histogram;
  for (int i = 0; i < 99; ++i) histogram.add(1ms);
  histogram.add(1s);
  EXPECT_LE(histogram.quantile(0.99), 1020us + 1us);
  EXPECT_EQ(histogram.quantile(1), 1s);
}

TEST(LatencyHistogram, TakesEveryTimeThereIs) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0us);
  histogram.add(core::Time::min());
  histogram.add(0us);
  histogram.add(core::Time::max());
  EXPECT_EQ(histogram.quantile(0.5), 0us);
  EXPECT_EQ(histogram.quantile(1), core::Time::max());
}

}  // namespace
}  // namespace nightjar::scenarios
