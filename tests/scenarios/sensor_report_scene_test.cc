#include "scenarios/sensor_report_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSize{346, 260};

TEST(SensorReportScene, the_grey_bars_have_their_reflectances) {
  const core::Image<float> bars = grey_bars(kSize, 5);
  for (const int y : {0, 259}) {
    EXPECT_FLOAT_EQ(bars(0, y), 0.5f);
    EXPECT_FLOAT_EQ(bars(86, y), 0.5f);
    EXPECT_FLOAT_EQ(bars(87, y), 1.5f);
    EXPECT_FLOAT_EQ(bars(200, y), 3.0f);
    EXPECT_FLOAT_EQ(bars(345, y), 4.5f);
  }
}

TEST(SensorReportScene, the_texture_moves_by_a_quarter_of_a_pixel_a_picture) {
  MovingPattern pattern(kSize, 5, 100, 0.1, 1);
  EXPECT_EQ(pattern.interval(), 2500us);
  EXPECT_EQ(pattern.pictures(), 41);
  const core::Image<float> before = pattern.draw(0);
  const core::Image<float> after = pattern.draw(4);
  const core::Image<float> bars = grey_bars(kSize, 5);
  for (int x = 0; x + 1 < kSize.width_px; ++x) {
    for (const int y : {65, 130, 194}) EXPECT_EQ(before(x + 1, y), after(x, y));
    for (const int y : {0, 64, 195, 259}) EXPECT_EQ(after(x, y), bars(x, y));
  }
}

TEST(SensorReportScene, the_slowest_texture_has_two_pictures_however_short_it_is) {
  EXPECT_EQ(MovingPattern(kSize, 5, 10, 0.02, 1).pictures(), 2);  // 25 ms from one to the next
}

// Standard deviation of 32 random waves seen through a window of 346x130 px: the longer
// waves do not average out, which shifts both by up to a few percent of a wave's own.
TEST(SensorReportScene, the_texture_has_the_contrast_that_it_claims) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    MovingPattern pattern(kSize, 5, 100, 2, seed);
    const core::Image<float>& picture = pattern.draw(0);
    double sum = 0, squares = 0, n = 0;
    for (int y = 65; y < 195; ++y)
      for (int x = 0; x < kSize.width_px; ++x) {
        const double value = std::log(picture(x, y) / 5);
        EXPECT_LE(value, 1e-6);  // no whiter than white
        sum += value;
        squares += value * value;
        ++n;
      }
    const double mean = sum / n;
    EXPECT_NEAR(mean, std::log(0.25), 0.04) << seed;
    EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.4, 0.04) << seed;
  }
}

TEST(SensorReportScene, another_seed_is_another_texture) {
  MovingPattern one(kSize, 5, 100, 0.1, 1), same(kSize, 5, 100, 0.1, 1),
      other(kSize, 5, 100, 0.1, 2);
  EXPECT_EQ(one.draw(3), same.draw(3));
  EXPECT_NE(one.draw(3), other.draw(3));
}

}  // namespace
}  // namespace nightjar::scenarios
