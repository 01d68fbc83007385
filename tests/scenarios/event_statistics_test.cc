#include "scenarios/event_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/poisson_events.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::Optional;

constexpr core::Resolution kSize{346, 260};
constexpr core::Resolution kSmall{8, 6};

EventStatistics figures(const std::vector<core::Event>& events, core::Resolution size,
                        core::Time end) {
  return event_statistics(pixel_activity(events, size, 0s, end));
}

TEST(EventStatistics, a_quantile_is_the_smallest_value_that_covers_the_share) {
  const std::vector<std::int64_t> values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_THAT(quantile(values, 0), Optional(1));
  EXPECT_THAT(quantile(values, 0.1), Optional(1));
  EXPECT_THAT(quantile(values, 0.11), Optional(2));
  EXPECT_THAT(quantile(values, 0.3), Optional(3));  // 0.3 * 10 is just above 3 in floats
  EXPECT_THAT(quantile(values, 0.5), Optional(5));
  EXPECT_THAT(quantile(values, 1), Optional(10));
  EXPECT_EQ(quantile({}, 0.5), std::nullopt);
}

TEST(EventStatistics, quantiles_of_known_intervals_are_exact) {
  // One pixel, intervals of 1, 2, ... 1000 ms; rarer than a hot pixel.
  std::vector<core::Event> events = {{0us, 3, 3, true}};
  for (int i = 1; i <= 1000; ++i) events.push_back({events.back().t + i * 1ms, 3, 3, i % 2 == 0});
  const IntervalFigures intervals = figures(events, kSmall, 600s).intervals;
  EXPECT_EQ(intervals.intervals, 1000u);
  EXPECT_THAT(intervals.minimum_us, Optional(1000));
  EXPECT_THAT(intervals.quantiles_us,
              ElementsAre(Optional(1000), Optional(10000), Optional(100000), Optional(500000),
                          Optional(900000), Optional(990000)));
}

TEST(EventStatistics, shares_of_on_are_those_of_the_events) {
  std::vector<core::Event> events;
  for (int i = 0; i < 10; ++i)
    events.push_back({i * 1ms, static_cast<std::uint16_t>(i % 8), 1, i < 4});
  const EventStatistics all = figures(events, kSmall, 1s);
  EXPECT_EQ(all.all.events, 10u);
  EXPECT_THAT(all.all.on_share, Optional(0.4));
  EXPECT_THAT(all.all.off_per_on, Optional(1.5));
}

TEST(EventStatistics, what_has_no_events_to_divide_by_is_nothing) {
  const EventStatistics none = figures({}, kSmall, 1s);
  EXPECT_EQ(none.all.on_share, std::nullopt);
  EXPECT_EQ(none.all.off_per_on, std::nullopt);
  EXPECT_EQ(none.hot.share_of_events, std::nullopt);
  EXPECT_EQ(none.hot.rate_median_hz, std::nullopt);
  EXPECT_EQ(none.intervals.minimum_us, std::nullopt);
  EXPECT_THAT(none.quiet.rate_hz, Optional(0.0));
  EXPECT_THAT(none.quiet.rate_error_hz, Optional(1.0 / kSmall.pixels()));
  const EventStatistics off = figures({{1ms, 0, 0, false}}, kSmall, 1s);
  EXPECT_THAT(off.all.on_share, Optional(0.0));
  EXPECT_EQ(off.all.off_per_on, std::nullopt);
}

TEST(EventStatistics, hot_pixels_come_hottest_first_and_with_their_share) {
  std::vector<core::Event> events;
  for (int i = 1; i <= 300; ++i) {
    const core::Time t = i * 10ms;
    events.push_back({t, 1, 1, true});
    if (i % 2 == 0) events.push_back({t, 6, 4, true});
    if (i % 3 == 0) events.push_back({t, 6, 0, true});
  }
  const HotPixelFigures hot = figures(events, kSmall, 3s).hot;
  ASSERT_EQ(hot.pixels.size(), 3u);
  EXPECT_EQ(hot.pixels[0].x, 1);
  EXPECT_EQ(hot.pixels[0].y, 1);
  EXPECT_DOUBLE_EQ(hot.pixels[0].rate_hz, 100);
  EXPECT_DOUBLE_EQ(hot.pixels[1].rate_hz, 50);
  EXPECT_DOUBLE_EQ(hot.pixels[2].rate_hz, 100.0 / 3);
  EXPECT_THAT(hot.rate_median_hz, Optional(50.0));
  EXPECT_THAT(hot.share_of_events, Optional(1.0));
}

// Over 3e6 pixel seconds; 5 Poisson deviations of the counts allowed.
TEST(EventStatistics, figures_of_poisson_noise_are_those_it_was_drawn_with) {
  for (const double rate_hz : {0.01, 0.5, 5.0}) {
    const auto noise =
        test::poisson_events(core::Image<double>(kSize, rate_hz), rate_hz, 0.6, 10s, 11);
    const EventStatistics all = figures(noise, kSize, 10s);
    const double expected = rate_hz * 10 * kSize.pixels();
    const double error = 5 / std::sqrt(expected);
    EXPECT_EQ(all.hot.pixels.size(), 0u);
    EXPECT_NEAR(all.rate_mean_hz, rate_hz, rate_hz * error);
    EXPECT_NEAR(*all.quiet.rate_hz, rate_hz, 5 * *all.quiet.rate_error_hz);
    EXPECT_NEAR(*all.quiet.rate_error_hz, rate_hz / std::sqrt(expected), 0.1 * rate_hz * error);
    EXPECT_NEAR(*all.quiet.polarity.on_share, 0.6, 5 * std::sqrt(0.6 * 0.4 / expected));
  }
}

// At 0.5 Hz over 10 s a pixel fires 5 times on average: the Poisson law's median is 5
// (0.440 up to 4, 0.616 up to 5), its 99 % quantile 11 (0.9863 up to 10, 0.9945 up to 11).
TEST(EventStatistics, rates_of_the_median_and_of_the_busiest_pixels_follow_the_poisson_law) {
  const auto noise = test::poisson_events(core::Image<double>(kSize, 0.5), 0.5, 0.5, 10s, 12);
  const EventStatistics all = figures(noise, kSize, 10s);
  EXPECT_DOUBLE_EQ(all.rate_median_hz, 0.5);
  EXPECT_DOUBLE_EQ(all.rate_99_hz, 1.1);
}

TEST(EventStatistics, pixels_of_all_kinds_add_up) {
  core::Image<double> rates_hz(kSize, 0.5);
  for (int y = 100; y < 150; ++y)
    for (int x = 0; x < kSize.width_px; ++x) rates_hz(x, y) = 30;
  rates_hz(20, 20) = 50;
  const auto events = test::poisson_events(rates_hz, 50, 0.5, 2s, 13);
  const EventStatistics all = figures(events, kSize, 2s);
  EXPECT_EQ(all.hot.pixels.size(), 1u);
  EXPECT_EQ(all.quiet.pixels + all.signal_pixels + 1, static_cast<std::uint64_t>(kSize.pixels()));
  EXPECT_NEAR(static_cast<double>(all.quiet.polarity.events + all.signal.events) +
                  *all.hot.share_of_events * static_cast<double>(all.all.events),
              static_cast<double>(all.all.events), 1e-6);
}

}  // namespace
}  // namespace nightjar::scenarios
