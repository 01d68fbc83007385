#include "sim/emulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/random.h"
#include "sim/noise.h"
#include "tests/support/sim_emulator_scenes.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;
using namespace test;

TEST(EventEmulator, shot_noise_has_v2es_rate_in_the_dark_and_in_the_light) {
  PixelConfig config = ideal();
  config.shot_noise_rate_hz = 5;
  const core::Resolution size{100, 50};
  for (const auto& [luminance_lux, factor] : {std::pair{0.0, 1 - 0.75 * 20 / 275}, {5.0, 0.25}})
    for (const std::uint64_t seed : {7u, 8u, 9u}) {
      EventEmulator emulator(config, size, kWhite_lux, seed);
      const auto events = run(emulator, size, still(luminance_lux), Time(2'000'000), Time(5'000));
      const double expected = size.pixels() * 2.0 * 5 * factor;
      const auto n = static_cast<double>(events.size());
      const auto on = static_cast<double>(std::ranges::count_if(events, &Event::on));
      EXPECT_NEAR(n, expected, 5 * std::sqrt(expected));
      EXPECT_NEAR(on, expected / 2, 5 * std::sqrt(expected / 2));
      EXPECT_EQ(emulator.counts().shot, events.size());
    }
}

TEST(EventEmulator, noise_has_no_comb_in_time) {
  PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  config.hot_pixel_fraction = 0.01;
  const core::Resolution size{100, 50};
  EventEmulator emulator(config, size, kWhite_lux, 10);
  constexpr int kStepUs = 5'000, kBins = 100;
  std::vector<double> offsets(kBins);  // of events after the begin of their step
  std::vector<double> intervals(100);  // of 1 us, from event to event over the sensor
  Time last{};
  for (const Event& e : run(emulator, size, still(1), Time(2'000'000), Time(kStepUs))) {
    ++offsets[static_cast<std::size_t>((e.t.count() - 1) % kStepUs / (kStepUs / kBins))];
    const auto interval_us = static_cast<std::size_t>((e.t - last).count());
    if (interval_us < intervals.size()) ++intervals[interval_us];
    last = e.t;
  }
  const double events = std::accumulate(offsets.begin(), offsets.end(), 0.0);
  ASSERT_GT(events, 30'000);
  for (const double n : offsets) EXPECT_NEAR(n, events / kBins, 5 * std::sqrt(events / kBins));
  const double rate_per_us = events / 2e6;
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    const double expected = events * rate_per_us * std::exp(-rate_per_us * static_cast<double>(i));
    EXPECT_NEAR(intervals[i], expected, 5 * std::sqrt(expected) + 0.03 * expected) << i;
  }
}

TEST(EventEmulator, leak_gives_on_events_at_its_rate_with_its_jitter) {
  PixelConfig config = ideal();
  config.leak_rate_hz = 2;
  config.threshold_on_sigma_log = 0.04;
  const core::Resolution size{100, 40};
  EventEmulator emulator(config, size, kWhite_lux, 12);
  std::vector<std::vector<double>> times_s(size.pixels());
  const auto events = run(emulator, size, still(2), Time(10'000'000), Time(10'000));
  for (const Event& e : events) {
    EXPECT_TRUE(e.on);
    times_s[e.y * size.width_px + e.x].push_back(core::seconds(e.t));
  }
  // Mean of a log-normal: exp((0.1 ln 10)^2 / 2) = 1.027 times the median. Its relative
  // deviation is 0.23; the phase adds less than one event a pixel.
  const double pixels = size.pixels();
  const double per_pixel = static_cast<double>(events.size()) / pixels;
  EXPECT_NEAR(per_pixel, 10 * 2 * 1.027, 5 * 10 * 2 * 0.24 / std::sqrt(pixels) + 0.05);

  double squares = 0, intervals = 0;
  for (const auto& times : times_s) {
    const auto n = static_cast<double>(times.size());
    if (n < 10) continue;
    const double mean = (times.back() - times[1]) / (n - 2);  // the first has no jitter
    for (std::size_t i = 2; i < times.size(); ++i) {
      const double off = (times[i] - times[i - 1]) / mean - 1;
      squares += off * off * (n - 2) / (n - 3);
      ++intervals;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / intervals), 0.1, 5 * 0.1 / std::sqrt(2 * intervals));
}

TEST(EventEmulator, hot_pixels_fire_at_their_rates_and_nothing_else_does) {
  PixelConfig config = ideal();
  config.hot_pixel_fraction = 0.002;
  const core::Resolution size{100, 50};
  EventEmulator emulator(config, size, kWhite_lux, 13);
  std::map<int, double> counts;
  for (const Event& e : run(emulator, size, still(2), Time(20'000'000), Time(100'000)))
    ++counts[e.y * size.width_px + e.x];
  ASSERT_GE(counts.size(), 3u);
  EXPECT_LE(counts.size(), 25u);  // 10 expected, 5 sigma
  double least = 1e9, most = 0;
  for (const auto& [pixel, n] : counts) {
    least = std::min(least, n / 20);
    most = std::max(most, n / 20);
  }
  EXPECT_GT(most / least, 3);  // deviation of ln(rate) 1.3
  EXPECT_GT(emulator.counts().hot, 0u);
  EXPECT_EQ(emulator.counts().signal, 0u);
}

TEST(EventEmulator, noise_rates_are_poisson_over_many_seeds) {
  // What is left of each seed's count, in units of its deviation, adds up to a standard
  // normal: within 5. Its squares add up to a chi-square, for which the bounds below are
  // those of 30 degrees of freedom at a probability of 1e-6 either side.
  const core::Resolution size{40, 25};
  constexpr int kSeeds = 30, kSeconds = 4;
  double shot = 0, hot = 0, leak = 0, shot_squares = 0, hot_squares = 0;
  for (std::uint64_t seed = 100; seed < 100 + kSeeds; ++seed) {
    PixelConfig config = ideal();
    config.shot_noise_rate_hz = 5;
    config.hot_pixel_fraction = 0.02;
    EventEmulator noisy(config, size, kWhite_lux, seed);
    run(noisy, size, still(0), Time(kSeconds * 1'000'000), Time(20'000));
    const double shot_expected = size.pixels() * kSeconds * 5 * (1 - 0.75 * 20 / 275);
    const double shot_off =
        (static_cast<double>(noisy.counts().shot) - shot_expected) / std::sqrt(shot_expected);
    shot += shot_off;
    shot_squares += shot_off * shot_off;
    const HotPixels pixels = draw_hot_pixels(config, size.pixels(), seed);
    const double hot_expected =
        kSeconds * std::accumulate(pixels.rates_hz.begin(), pixels.rates_hz.end(), 0.0);
    const double hot_off =
        (static_cast<double>(noisy.counts().hot) - hot_expected) / std::sqrt(hot_expected);
    hot += hot_off;
    hot_squares += hot_off * hot_off;

    PixelConfig leaky = ideal();
    leaky.leak_rate_hz = 2;
    leaky.leak_spread_decades = 0;
    EventEmulator leaking(leaky, size, kWhite_lux, seed);
    run(leaking, size, still(0), Time(kSeconds * 1'000'000), Time(20'000));
    // More regular than Poisson: a uniform phase and ten per cent a draw.
    const double leak_expected = size.pixels() * kSeconds * 2.0;
    leak +=
        (static_cast<double>(leaking.counts().signal) - leak_expected) / std::sqrt(leak_expected);
  }
  EXPECT_LT(std::abs(shot) / std::sqrt(kSeeds), 5);
  EXPECT_LT(std::abs(hot) / std::sqrt(kSeeds), 5);
  EXPECT_LT(std::abs(leak) / std::sqrt(kSeeds), 5);
  for (const double squares : {shot_squares, hot_squares}) {
    EXPECT_GT(squares, 6.5);
    EXPECT_LT(squares, 83);
  }
}

TEST(EventEmulator, intervals_of_a_pixel_have_no_gap_and_no_comb_below_100_us) {
  // 950 events a second and pixel, far denser than steps of 5 ms.
  PixelConfig config = ideal();
  config.shot_noise_rate_hz = 1000;
  const core::Resolution size{60, 50};
  EventEmulator emulator(config, size, kWhite_lux, 21);
  std::map<int, Time> last;
  std::vector<double> bins(100);  // of 1 us
  double intervals = 0;
  for (const Event& e : run(emulator, size, still(0), Time(500'000), Time(5'000))) {
    const int pixel = e.y * size.width_px + e.x;
    if (last.contains(pixel)) {
      ++intervals;
      const auto bin = static_cast<std::size_t>((e.t - last[pixel]).count());
      if (bin < bins.size()) ++bins[bin];
    }
    last[pixel] = e.t;
  }
  // Both ends are rounded up to a microsecond, so that n us stand for n - 1 to n + 1, the
  // outer ones less, on average n; 0 us would be half a bin. Of 100 bins each with Poisson
  // numbers one may be off by 5 sigma once in 20,000 runs; all together are a chi-square
  // of 99 or 100, within 5 sigma.
  const double per_us = 1000e-6 * (1 - 0.75 * 20 / 275);
  double chi_square = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double expected =
        (i == 0 ? 0.5 : 1) * intervals * per_us * std::exp(-per_us * static_cast<double>(i));
    ASSERT_GT(expected, 500);
    EXPECT_NEAR(bins[i], expected, 5 * std::sqrt(expected)) << i;
    chi_square += (bins[i] - expected) * (bins[i] - expected) / expected;
  }
  EXPECT_NEAR(chi_square, 100, 5 * std::sqrt(2 * 100.0));
}

TEST(EventEmulator, each_random_effect_leaves_the_draws_of_the_others) {
  // A pixel that none of the other effects touched has to leak as if they were off.
  const core::Resolution size{60, 40};
  PixelConfig all = ideal();
  all.threshold_on_sigma_log = all.threshold_off_sigma_log = 0.03;
  all.leak_rate_hz = 3;
  all.shot_noise_rate_hz = 0.5;
  all.hot_pixel_fraction = 0.01;
  const auto by_pixel = [&](const PixelConfig& config) {
    EventEmulator emulator(config, size, kWhite_lux, 23);
    std::vector<std::vector<Event>> events(size.pixels());
    for (const Event& e : run(emulator, size, still(1), Time(1'000'000), Time(5'000)))
      events[e.y * size.width_px + e.x].push_back(e);
    return events;
  };
  const auto together = by_pixel(all);
  PixelConfig config = all;
  config.shot_noise_rate_hz = config.hot_pixel_fraction = 0;
  const auto leak = by_pixel(config);
  config = all;
  config.leak_rate_hz = config.hot_pixel_fraction = 0;
  const auto shot = by_pixel(config);
  config = all;
  config.leak_rate_hz = config.shot_noise_rate_hz = 0;
  const auto hot = by_pixel(config);
  int leak_alone = 0, noise_alone = 0;
  for (int p = 0; p < size.pixels(); ++p) {
    if (shot[p].empty() && hot[p].empty()) {
      EXPECT_EQ(together[p], leak[p]) << p;
      leak_alone += !leak[p].empty();
    }
    // Noise comes at its own times, whatever else the pixel does.
    for (const auto* noise : {&shot[p], &hot[p]})
      for (const Event& e : *noise) {
        EXPECT_NE(std::ranges::find(together[p], e), together[p].end()) << p;
        ++noise_alone;
      }
  }
  EXPECT_GT(leak_alone, 1000);
  EXPECT_GT(noise_alone, 1000);
}

TEST(EventEmulator, switching_one_effect_off_leaves_the_draws_of_others) {
  const core::Resolution size{40, 30};
  PixelConfig all = ideal();
  all.shot_noise_rate_hz = 5;
  all.hot_pixel_fraction = 0.01;
  PixelConfig no_shot = all;
  no_shot.shot_noise_rate_hz = 0;
  PixelConfig mismatch = all;
  mismatch.threshold_on_sigma_log = 0.03;
  EventEmulator with(all, size, kWhite_lux, 16), without(no_shot, size, kWhite_lux, 16),
      third(mismatch, size, kWhite_lux, 16);
  const auto all_events = run(with, size, still(2), Time(1'000'000), Time(5'000));
  const auto hot_events = run(without, size, still(2), Time(1'000'000), Time(5'000));
  ASSERT_GT(hot_events.size(), 100u);
  ASSERT_GT(with.counts().shot, 100u);
  for (const Event& e : hot_events) EXPECT_NE(std::ranges::find(all_events, e), all_events.end());
  EXPECT_TRUE(std::ranges::equal(with.thresholds_off_log(), third.thresholds_off_log()));
}

TEST(EventEmulator, noise_does_not_depend_on_the_step) {
  PixelConfig config = ideal();
  config.shot_noise_rate_hz = 5;
  config.hot_pixel_fraction = 0.01;
  const core::Resolution size{40, 30};
  EventEmulator coarse(config, size, kWhite_lux, 17), fine(config, size, kWhite_lux, 17);
  EXPECT_EQ(run(coarse, size, still(2), Time(900'000), Time(9'000)),
            run(fine, size, still(2), Time(900'000), Time(1'000)));
}

}  // namespace
}  // namespace nightjar::sim
