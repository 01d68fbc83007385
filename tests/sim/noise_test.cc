#include "sim/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nightjar::sim {
namespace {

using core::Time;

TEST(PointProcess, every_source_fires_at_its_own_rate) {
  const std::vector<double> rates_hz{0.5, 40, 3, 0, 12, 300};
  PointProcess process(rates_hz, core::random_stream(1, "test"));
  process.start(Time(0));
  std::vector<NoisePoint> points;
  process.draw(std::chrono::seconds(1000), points);
  std::vector<double> counts(rates_hz.size());
  for (const NoisePoint& point : points) ++counts[point.source];
  for (std::size_t i = 0; i < rates_hz.size(); ++i) {
    const double expected = rates_hz[i] * 1000;
    EXPECT_NEAR(counts[i], expected, 5 * std::sqrt(expected)) << i;  // 5 sigma of Poisson
  }
}

TEST(PointProcess, counts_are_poisson_and_gaps_exponential) {
  // 4000 windows with 10 points expected. The variance of a sample variance of
  // Poisson(10) over n windows is about (2 * 100 + 10)/n.
  PointProcess process(std::vector<double>{100.0}, core::random_stream(2, "test"));
  process.start(Time(0));
  double sum = 0, squares = 0, gaps_above_mean = 0, last_us = 0;
  constexpr int kWindows = 4000;
  for (int i = 1; i <= kWindows; ++i) {
    std::vector<NoisePoint> points;
    process.draw(Time(i * 100'000), points);
    const auto n = static_cast<double>(points.size());
    sum += n;
    squares += n * n;
    for (const NoisePoint& point : points) {
      gaps_above_mean += point.t_us - last_us > 10'000;
      last_us = point.t_us;
    }
  }
  const double mean = sum / kWindows;
  const double variance = squares / kWindows - mean * mean;
  EXPECT_NEAR(mean, 10, 5 * std::sqrt(10.0 / kWindows));
  EXPECT_NEAR(variance, 10, 5 * std::sqrt(210.0 / kWindows));
  const double share = gaps_above_mean / sum;  // exp(-1)
  EXPECT_NEAR(share, std::exp(-1.0), 5 * std::sqrt(0.37 * 0.63 / sum));
}

TEST(PointProcess, points_do_not_depend_on_the_steps) {
  const std::vector<double> rates_hz(50, 20.0);
  PointProcess coarse(rates_hz, core::random_stream(3, "test"));
  PointProcess fine(rates_hz, core::random_stream(3, "test"));
  coarse.start(Time(77));
  fine.start(Time(77));
  std::vector<NoisePoint> once, often;
  coarse.draw(Time(500'000), once);
  for (int t = 100; t <= 500'000; t += 700) fine.draw(Time(t), often);
  fine.draw(Time(500'000), often);
  ASSERT_EQ(once.size(), often.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].t_us, often[i].t_us);
    EXPECT_EQ(once[i].source, often[i].source);
    EXPECT_EQ(once[i].mark, often[i].mark);
  }
}

TEST(PointProcess, nothing_fires_without_a_rate) {
  std::vector<NoisePoint> points;
  for (const std::vector<double>& rates_hz : {std::vector<double>{}, {0.0, 0.0}}) {
    PointProcess process(rates_hz, core::random_stream(4, "test"));
    process.start(Time(0));
    process.draw(std::chrono::hours(1), points);
  }
  EXPECT_TRUE(points.empty());
}

TEST(ShotNoise, follows_v2e_in_intensity_and_threshold) {
  EXPECT_NEAR(shot_noise_factor(0), 1 - 0.75 * 20 / 275, 1e-12);
  EXPECT_NEAR(shot_noise_factor(255), 0.25, 1e-12);
  EXPECT_NEAR(shot_noise_factor(5000), 0.25, 1e-12);
  const std::vector<float> thresholds{0.1f, 0.2f, 0.4f};
  const std::vector<double> rates_hz = shot_noise_rates_hz(5, 0.2, thresholds);
  EXPECT_NEAR(rates_hz[0], 5.0, 1e-6);  // single precision of the thresholds
  EXPECT_NEAR(rates_hz[1], 2.5, 1e-6);
  EXPECT_NEAR(rates_hz[2], 1.25, 1e-6);
}

TEST(Thresholds, are_gaussian_and_never_below_the_least) {
  constexpr std::size_t kPixels = 89960;
  const auto wide = draw_thresholds_log(0.2, 0.1, kPixels, core::random_stream(5, "test"));
  EXPECT_EQ(*std::ranges::min_element(wide), 0.01f);
  const auto narrow = draw_thresholds_log(0.2, 0.03, kPixels, core::random_stream(5, "test"));
  double sum = 0, squares = 0;
  for (const float t : narrow) {
    sum += t;
    squares += (t - 0.2) * (t - 0.2);
  }
  // Standard errors of mean and deviation: sigma/sqrt(n) and sigma/sqrt(2n).
  const double root = std::sqrt(static_cast<double>(kPixels));
  EXPECT_NEAR(sum / kPixels, 0.2, 5 * 0.03 / root);
  EXPECT_NEAR(std::sqrt(squares / kPixels), 0.03, 5 * 0.03 / root / std::sqrt(2.0));
}

TEST(HotPixels, have_a_heavy_tail_around_the_median) {
  PixelConfig config;
  config.hot_pixel_fraction = 0.05;
  HotPixels hot = draw_hot_pixels(config, 200'000, 6);
  const auto n = static_cast<double>(hot.pixels.size());
  EXPECT_NEAR(n, 10'000, 5 * std::sqrt(10'000 * 0.95));  // binomial
  double logs = 0, squares = 0;
  for (const double rate_hz : hot.rates_hz) {
    const double log = std::log(rate_hz / config.hot_pixel_rate_median_hz);
    logs += log;
    squares += log * log;
  }
  const double sigma = config.hot_pixel_rate_sigma_ln;
  EXPECT_NEAR(logs / n, 0, 5 * sigma / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), sigma, 5 * sigma / std::sqrt(2 * n));
}

TEST(HotPixels, more_of_them_leave_the_first_ones_as_they_were) {
  PixelConfig config;
  config.hot_pixel_fraction = 1e-3;
  const HotPixels few = draw_hot_pixels(config, 89960, 7);
  config.hot_pixel_fraction = 1e-2;
  const HotPixels many = draw_hot_pixels(config, 89960, 7);
  ASSERT_FALSE(few.pixels.empty());
  for (std::size_t i = 0; i < few.pixels.size(); ++i) {
    const auto it = std::ranges::find(many.pixels, few.pixels[i]);
    ASSERT_NE(it, many.pixels.end());
    EXPECT_EQ(many.rates_hz[static_cast<std::size_t>(it - many.pixels.begin())], few.rates_hz[i]);
  }
}

}  // namespace
}  // namespace nightjar::sim
