#include "scenarios/pixel_activity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/random.h"
#include "tests/support/poisson_events.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

using Counts = core::Image<std::uint32_t>;

constexpr core::Resolution kSize{346, 260};
constexpr core::Resolution kSmall{8, 6};

std::ptrdiff_t number_of(const core::Image<PixelKind>& kinds, PixelKind kind) {
  return std::count(kinds.pixels().begin(), kinds.pixels().end(), kind);
}

Counts poisson_counts(const core::Image<double>& rates_hz, double most_hz, core::Time duration,
                      std::uint64_t seed) {
  const auto events = test::poisson_events(rates_hz, most_hz, 0.5, duration, seed);
  return pixel_activity(events, rates_hz.size(), 0s, duration).events;
}

TEST(PixelActivity, counts_the_events_of_each_pixel_and_the_on_events_among_them) {
  const std::vector<core::Event> events = {
      {0us, 1, 2, true}, {1us, 1, 2, false}, {1us, 7, 5, true}, {9us, 1, 2, true}};
  const PixelActivity activity = pixel_activity(events, kSmall, 0us, 10us);
  EXPECT_DOUBLE_EQ(activity.duration_s, 1e-5);
  EXPECT_EQ(activity.events(1, 2), 3u);
  EXPECT_EQ(activity.on_events(1, 2), 2u);
  EXPECT_EQ(activity.events(7, 5), 1u);
  EXPECT_EQ(activity.events(0, 0), 0u);
}

TEST(PixelActivity, intervals_lie_between_events_of_the_same_pixel) {
  const std::vector<core::Event> events = {{0us, 1, 1, true},
                                           {3us, 2, 1, true},
                                           {50us, 1, 1, false},
                                           {60us, 2, 1, true},
                                           {61us, 1, 1, true}};
  EXPECT_THAT(pixel_activity(events, kSmall, 0us, 100us).intervals_us, ElementsAre(11, 50, 57));
}

TEST(PixelActivity, intervals_of_a_hot_pixel_do_not_count) {
  std::vector<core::Event> events;
  for (int i = 1; i <= 100; ++i) events.push_back({i * 10ms, 4, 3, true});
  events.push_back({1001ms, 0, 0, true});
  events.push_back({1005ms, 0, 0, true});
  const PixelActivity activity = pixel_activity(events, kSmall, 0s, 2s);
  EXPECT_EQ(activity.kinds(4, 3), PixelKind::hot);
  EXPECT_THAT(activity.intervals_us, ElementsAre(4000));
}

// A pixel that fires 5 times on average gets to 200 once in 10^200 times.
TEST(PixelActivity, poisson_noise_holds_no_hot_pixel) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Counts counts = poisson_counts(core::Image<double>(kSize, 0.5), 0.5, 10s, seed);
    EXPECT_EQ(number_of(classify_pixels(counts, 10), PixelKind::hot), 0);
  }
}

// In a short recording the least number of events decides: with a mean of 1, 12 come
// about once in 10^9 times.
TEST(PixelActivity, poisson_noise_holds_no_hot_pixel_in_a_short_time_either) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Counts counts = poisson_counts(core::Image<double>(kSize, 10.0), 10, 100ms, seed);
    EXPECT_EQ(number_of(classify_pixels(counts, 0.1), PixelKind::hot), 0);
  }
}

TEST(PixelActivity, finds_just_the_hot_pixels_that_were_put_into_noise) {
  Counts counts = poisson_counts(core::Image<double>(kSize, 0.5), 0.5, 10s, 1);
  // The five of an indoor recording, 32 to 163 Hz: in a corner, at a rim, side by side.
  counts(0, 0) = 320;
  counts(345, 100) = 400;
  counts(200, 130) = 900;
  counts(201, 130) = 1630;
  counts(50, 259) = 600;
  const auto kinds = classify_pixels(counts, 10);
  for (const auto& [x, y] : {std::pair{0, 0}, {345, 100}, {200, 130}, {201, 130}, {50, 259}})
    EXPECT_EQ(kinds(x, y), PixelKind::hot) << x << ", " << y;
  EXPECT_EQ(number_of(kinds, PixelKind::hot), 5);
}

TEST(PixelActivity, an_outline_of_a_pixels_width_is_signal_and_not_hot) {
  Counts counts(kSize);
  for (int i = 100; i <= 150; ++i) counts(i, 100) = counts(i, 150) = 1000;
  for (int i = 100; i <= 150; ++i) counts(100, i) = counts(150, i) = 1000;
  const auto kinds = classify_pixels(counts, 10);
  EXPECT_EQ(number_of(kinds, PixelKind::hot), 0);
  for (int i = 100; i <= 150; ++i) EXPECT_EQ(kinds(i, 100), PixelKind::signal);
}

TEST(PixelActivity, pixels_within_4_px_of_signal_are_not_quiet) {
  core::Image<double> rates_hz(kSize, 0.5);
  for (int y = 100; y < 150; ++y)
    for (int x = 0; x < kSize.width_px; ++x) rates_hz(x, y) = 30;
  const auto kinds = classify_pixels(poisson_counts(rates_hz, 30, 2s, 1), 2);
  for (int x = 0; x < kSize.width_px; ++x) {
    for (int y = 96; y < 154; ++y) EXPECT_NE(kinds(x, y), PixelKind::quiet) << x << ", " << y;
    for (const int y : {90, 95, 154, 160}) EXPECT_EQ(kinds(x, y), PixelKind::quiet);
  }
}

TEST(PixelActivity, the_neighbours_of_a_hot_pixel_stay_quiet) {
  Counts counts = poisson_counts(core::Image<double>(kSize, 0.5), 0.5, 10s, 1);
  counts(100, 100) = 20000;
  const auto kinds = classify_pixels(counts, 10);
  EXPECT_EQ(kinds(99, 100), PixelKind::quiet);
  EXPECT_EQ(number_of(kinds, PixelKind::quiet), kSize.pixels() - 1);
}

TEST(PixelActivity, a_pixels_own_events_do_not_decide_whether_it_is_quiet) {
  Counts counts(kSize);
  counts(100, 100) = 5;
  EXPECT_EQ(classify_pixels(counts, 10)(100, 100), PixelKind::quiet);
}

// v2e's factors for white and black are 0.25 and 0.95.
TEST(PixelActivity, the_shot_noise_of_black_and_white_is_quiet_alike) {
  core::Image<double> rates_hz(kSize);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x) rates_hz(x, y) = x < 173 ? 0.25 * 5 : 0.95 * 5;
  const auto kinds = classify_pixels(poisson_counts(rates_hz, 5, 10s, 1), 10);
  EXPECT_EQ(number_of(kinds, PixelKind::quiet), kSize.pixels());
}

// What is taken for quiet must not depend on what is then counted. Standard error by
// Poisson, 5 of it allowed.
TEST(PixelActivity, the_rate_of_quiet_pixels_is_that_of_the_noise_however_rare) {
  for (const double noise_hz : {0.003, 0.01, 0.1, 1.0, 10.0}) {
    Counts counts = poisson_counts(core::Image<double>(kSize, noise_hz), noise_hz, 1s, 7);
    for (int y = 60; y < 200; ++y)
      for (int x = 0; x < kSize.width_px; ++x) counts(x, y) += 100;
    const auto kinds = classify_pixels(counts, 1);
    double pixels = 0, events = 0;
    for (std::size_t i = 0; i < kinds.pixels().size(); ++i) {
      if (kinds.pixels()[i] != PixelKind::quiet) continue;
      ++pixels;
      events += counts.pixels()[i];
    }
    // All that is 4 px away from the band, but for what chance excludes.
    EXPECT_GT(pixels, 0.9 * 346 * (56 + 56));
    EXPECT_NEAR(events, pixels * noise_hz, 5 * std::sqrt(pixels * noise_hz)) << noise_hz;
  }
}

TEST(PixelActivity, a_sensor_without_events_is_quiet) {
  const PixelActivity activity = pixel_activity({}, kSmall, 0s, 1s);
  EXPECT_EQ(number_of(activity.kinds, PixelKind::quiet), kSmall.pixels());
  EXPECT_TRUE(activity.intervals_us.empty());
}

TEST(PixelActivity, a_sensor_of_one_pixel_will_do) {
  const std::vector<core::Event> events = {{1us, 0, 0, true}};
  EXPECT_EQ(pixel_activity(events, {1, 1}, 0s, 1s).events(0, 0), 1u);
}

TEST(PixelActivity, refuses_what_lies_outside_of_the_sensor_or_the_time) {
  const auto refused = [](std::vector<core::Event> events) {
    EXPECT_THROW(pixel_activity(events, kSmall, 10us, 20us), std::invalid_argument);
  };
  refused({{15us, 8, 0, true}});
  refused({{15us, 0, 6, true}});
  refused({{9us, 0, 0, true}});
  refused({{21us, 0, 0, true}});
  refused({{15us, 0, 0, true}, {14us, 0, 0, true}});
  EXPECT_THROW(pixel_activity({}, {0, 6}, 10us, 20us), std::invalid_argument);
  EXPECT_THROW(pixel_activity({}, kSmall, 10us, 10us), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
