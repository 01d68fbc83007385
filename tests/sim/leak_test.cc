#include "sim/leak.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace nightjar::sim {
namespace {

TEST(LeakDeviation, is_close_to_a_standard_normal) {
  constexpr int kDraws = 200'000;
  double sum = 0, squares = 0, within_1 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double d = leak_deviation(8, static_cast<std::uint32_t>(i % 1000),
                                    static_cast<std::uint32_t>(i / 1000));
    sum += d;
    squares += d * d;
    within_1 += std::abs(d) < 1;
  }
  const double root = std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(sum / kDraws, 0, 5 / root);
  EXPECT_NEAR(squares / kDraws, 1, 5 * std::sqrt(1.7) / root);  // kurtosis 2.7 of four uniforms
  EXPECT_NEAR(within_1 / kDraws, 0.68, 0.02);                   // a normal's share, roughly
}

TEST(Leak, without_spread_and_jitter_is_the_rate_times_the_threshold) {
  PixelConfig config;
  config.leak_rate_hz = 3;
  config.leak_spread_decades = config.leak_jitter = 0;
  const std::vector<float> thresholds_log{0.1f, 0.4f};
  Leak leak(config, thresholds_log, 9);
  EXPECT_TRUE(leak.enabled());
  EXPECT_FLOAT_EQ(leak.mean_per_s(1), 1.2f);
  EXPECT_FLOAT_EQ(leak.next_per_s(0), 0.3f);
  config.leak_rate_hz = 0;
  EXPECT_FALSE(Leak(config, thresholds_log, 9).enabled());
}

TEST(Leak, draws_of_a_pixel_do_not_depend_on_those_of_others) {
  const std::vector<float> thresholds_log(10, 0.2f);
  Leak alone(PixelConfig(), thresholds_log, 10), among(PixelConfig(), thresholds_log, 10);
  for (int i = 0; i < 5; ++i) {
    among.next_per_s(2);
    EXPECT_EQ(alone.next_per_s(7), among.next_per_s(7));
  }
  EXPECT_NE(alone.next_per_s(7), among.next_per_s(2));
}

TEST(Leak, draws_spread_and_jitter_from_streams_of_their_own) {
  PixelConfig config;
  config.leak_rate_hz = 3;
  const std::vector<float> thresholds_log(10, 0.2f);
  Leak leak(config, thresholds_log, 12);
  core::Random spread = core::random_stream(12, "leak_spread");
  const std::uint64_t jitter = core::random_stream(12, "leak_jitter")();
  ASSERT_NE(core::random_stream(12, "leak_spread")(), jitter);
  for (std::uint32_t p = 0; p < 10; ++p) {
    const double mean = 0.6 * std::pow(10, config.leak_spread_decades * core::normal(spread));
    EXPECT_FLOAT_EQ(leak.mean_per_s(p), static_cast<float>(mean));
    const double deviation = leak_deviation(jitter, p, 0);
    EXPECT_FLOAT_EQ(leak.next_per_s(p),
                    static_cast<float>(mean / (1 + config.leak_jitter * deviation)));
  }
}

}  // namespace
}  // namespace nightjar::sim
