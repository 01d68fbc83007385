#include "sim/emulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "core/random.h"
#include "tests/support/sim_moving_texture.h"
#include "tests/support/sim_scalar_emulator.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;
using test::ScalarEvent;
using test::ScalarPixel;

constexpr double kWhite_lux = 5.0;

/// Luminance of a pixel (lux) at a time (s).
using Scene = std::function<double(int x, int y, double t_s)>;

core::Image<float> picture(core::Resolution size, const Scene& scene, double t_s) {
  core::Image<float> image(size);
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x) image(x, y) = static_cast<float>(scene(x, y, t_s));
  return image;
}

/// Steps of `dt` from 0 to `end`; the events of all.
std::vector<Event> run(EventEmulator& emulator, core::Resolution size, const Scene& scene, Time end,
                       Time dt) {
  std::vector<Event> events;
  for (Time t{}; t <= end; t += dt)
    emulator.step(t, picture(size, scene, core::seconds(t)), events);
  return events;
}

/// No noise, no mismatch, no low pass.
PixelConfig ideal() {
  PixelConfig config = preset_pixel(SensorPreset::clean, 5);
  config.threshold_on_sigma_log = config.threshold_off_sigma_log = 0;
  return config;
}

PixelConfig only_low_pass(double cutoff_hz) {
  PixelConfig config = ideal();
  config.cutoff_hz = cutoff_hz;
  return config;
}

Scene still(double luminance_lux) {
  return [luminance_lux](int, int, double) { return luminance_lux; };
}

/// Log intensity moves by 2.5 up and down; each pixel a little differently.
double sine(int x, int y, double t_s) {
  return std::exp(0.2 + 1.2 * std::sin(2 * std::numbers::pi * (3 * t_s + 0.03 * x + 0.1 * y)));
}
double ramp(int x, int y, double t_s) { return 0.5 + (0.4 + 0.02 * x + 0.1 * y) * 5 * t_s; }
double jump(int x, int, double t_s) { return t_s < 0.1 + 0.001 * x ? 0.3 : 4.0; }
double edge(int x, int y, double t_s) {
  // A slanted edge, 2 px wide, that crosses the picture.
  const double distance_px = x + 0.3 * y - 100 * t_s + 5;
  return 2.2 - 1.8 * std::tanh(distance_px);
}

struct NamedScene {
  const char* name;
  double (*scene)(int, int, double);
};

class RoundTrip : public testing::TestWithParam<std::tuple<NamedScene, double>> {};

TEST_P(RoundTrip, sum_of_events_stays_within_a_threshold_of_the_photoreceptor) {
  const auto [named, cutoff_hz] = GetParam();
  const core::Resolution size{16, 4};
  PixelConfig config = only_low_pass(cutoff_hz);
  config.threshold_on_log = 0.15;
  config.threshold_off_log = 0.11;
  EventEmulator emulator(config, size, kWhite_lux, 1);

  std::vector<ScalarPixel> truth(size.pixels(), ScalarPixel(config, kWhite_lux, 0.15, 0.11));
  std::vector<double> start(size.pixels()), sum(size.pixels());
  for (Time t{}; t <= Time(300'000); t += Time(2'500)) {
    const auto image = picture(size, named.scene, core::seconds(t));
    std::vector<Event> events;
    emulator.step(t, image, events);
    for (const Event& e : events)
      sum[e.y * size.width_px + e.x] += e.on ? config.threshold_on_log : -config.threshold_off_log;
    for (int p = 0; p < size.pixels(); ++p) {
      const double lux = image.pixels()[p];
      const double t_us = static_cast<double>(t.count());
      if (t == Time{}) {
        truth[p].start(t_us, lux);
        start[p] = truth[p].output();
        continue;
      }
      truth[p].step(t_us, lux);
      const double left = truth[p].output() - start[p] - sum[p];
      // 1e-4: single precision, and crossings found to 0.05 us.
      EXPECT_LT(left, config.threshold_on_log + 1e-4);
      EXPECT_GT(left, -config.threshold_off_log - 1e-4);
    }
  }
  EXPECT_GT(emulator.counts().signal, 100u);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, RoundTrip,
    testing::Combine(testing::Values(NamedScene{"sine", sine}, NamedScene{"ramp", ramp},
                                     NamedScene{"jump", jump}, NamedScene{"edge", edge}),
                     testing::Values(0.0, 30.0)),
    [](const auto& round_trip) {
      return std::string(std::get<0>(round_trip.param).name) +
             (std::get<1>(round_trip.param) > 0 ? "_low_pass" : "_direct");
    });

/// The scalar reference's events, in the emulator's order.
std::vector<std::vector<ScalarEvent>> reference(const PixelConfig& config, core::Resolution size,
                                                const Scene& scene, Time end, Time dt,
                                                const EventEmulator& like) {
  std::vector<std::vector<ScalarEvent>> events(size.pixels());
  for (int p = 0; p < size.pixels(); ++p) {
    ScalarPixel pixel(config, kWhite_lux, like.thresholds_on_log()[p],
                      like.thresholds_off_log()[p]);
    for (Time t{}; t <= end; t += dt) {
      const auto lux =
          static_cast<float>(scene(p % size.width_px, p / size.width_px, core::seconds(t)));
      if (t == Time{}) {
        pixel.start(0, lux);
        continue;
      }
      const auto step = pixel.step(static_cast<double>(t.count()), lux);
      events[p].insert(events[p].end(), step.begin(), step.end());
    }
  }
  return events;
}

void expect_like_reference(const PixelConfig& config, const Scene& scene) {
  const core::Resolution size{60, 5};  // more than one block of pixels
  EventEmulator emulator(config, size, kWhite_lux, 2);
  const Time end(300'000), dt(3'000);
  const auto truth = reference(config, size, scene, end, dt, emulator);
  std::vector<std::vector<ScalarEvent>> found(size.pixels());
  for (const Event& e : run(emulator, size, scene, end, dt))
    found[e.y * size.width_px + e.x].push_back({static_cast<double>(e.t.count()), e.on});
  for (int p = 0; p < size.pixels(); ++p) {
    ASSERT_EQ(found[p].size(), truth[p].size()) << p;
    for (std::size_t i = 0; i < truth[p].size(); ++i) {
      EXPECT_EQ(found[p][i].on, truth[p][i].on);
      // Rounded up to a microsecond. Single precision carries errors of 2e-6 over 100
      // steps, which a slope of 0.2/s turns into 10 us.
      EXPECT_NEAR(found[p][i].t_us, truth[p][i].t_us + 0.5, 10) << p << ' ' << i;
    }
  }
}

TEST(EventEmulator, gives_the_events_of_the_scalar_reference) {
  PixelConfig config = only_low_pass(40);
  config.threshold_on_sigma_log = config.threshold_off_sigma_log = 0.03;
  expect_like_reference(config, sine);
  expect_like_reference(config, edge);
  config.cutoff_hz = 0;
  expect_like_reference(config, sine);
}

TEST(EventEmulator, rests_as_the_scalar_reference_does) {
  // Shorter than a step, longer than one, longer than several.
  for (const double refractory_us : {300.0, 4'000.0, 20'000.0}) {
    PixelConfig config = only_low_pass(50);  // the reference takes no step in parts
    config.refractory_us = refractory_us;
    expect_like_reference(config, sine);
  }
}

TEST(EventEmulator, leaks_as_the_scalar_reference_does) {
  PixelConfig config = only_low_pass(40);
  config.leak_rate_hz = 3;
  config.leak_spread_decades = config.leak_jitter = 0;
  config.threshold_on_log = 0.25;
  const core::Resolution size{8, 8};
  EventEmulator emulator(config, size, kWhite_lux, 3);
  // Leak starts at a random phase; from the first event on it is as regular as the
  // reference's, which has no phase.
  std::map<std::pair<int, int>, std::vector<Time>> events;
  for (const Event& e : run(emulator, size, still(2), Time(3'000'000), Time(3'000))) {
    EXPECT_TRUE(e.on);
    events[{e.x, e.y}].push_back(e.t);
  }
  EXPECT_EQ(events.size(), static_cast<std::size_t>(size.pixels()));
  for (const auto& [pixel, times] : events)
    for (std::size_t i = 1; i < times.size(); ++i)
      // Half an ulp of the residual (7e-9) over each step's 2.25e-3 of leak: 1e-5.
      EXPECT_NEAR(static_cast<double>((times[i] - times[i - 1]).count()), 1e6 / 3, 10);
}

TEST(EventEmulator, result_hardly_depends_on_the_step) {
  // The same scene in steps of 0.5, 2 and 8 ms against 0.1 ms: the straight lines
  // between the samples of log intensity are the only difference. Over a step the
  // sine departs from its chord by A w^2 dt^2 / 8 (at 8 ms 0.0034, at 2 ms 2e-4), its
  // slope is A w = 23/s at most, so that times move by 0.15 ms (0.01 ms), plus what
  // the same amount does near a turning point, where an event can be had or not.
  PixelConfig config = only_low_pass(30);
  const core::Resolution size{16, 4};
  const auto events_at = [&](int dt_us) {
    EventEmulator emulator(config, size, kWhite_lux, 4);
    return run(emulator, size, sine, Time(400'000), Time(dt_us));
  };
  const std::vector<Event> truth = events_at(100);
  ASSERT_GT(truth.size(), 1000u);
  for (const auto& [dt_us, mean_us, missing] :
       {std::tuple{500, 5.0, 0.001}, {2'000, 30.0, 0.005}, {8'000, 300.0, 0.02}}) {
    const std::vector<Event> events = events_at(dt_us);
    EXPECT_NEAR(static_cast<double>(events.size()) / static_cast<double>(truth.size()), 1, missing);
    // Every event has one of the same pixel and sign near it.
    std::map<std::tuple<int, int, bool>, std::vector<Time>> known;
    for (const Event& e : truth) known[{e.x, e.y, e.on}].push_back(e.t);
    double sum_us = 0;
    for (const Event& e : events) {
      double nearest_us = 1e9;
      for (const Time t : known[{e.x, e.y, e.on}])
        nearest_us = std::min(nearest_us, std::abs(static_cast<double>((t - e.t).count())));
      sum_us += nearest_us;
    }
    EXPECT_LT(sum_us / static_cast<double>(events.size()), mean_us) << dt_us;
  }
}

TEST(EventEmulator, low_pass_shrinks_a_sinusoid_as_the_closed_form_says) {
  // A small sinusoid about mid grey: k is nearly constant, so the output's amplitude
  // is A' = A / sqrt(1 + (w/k)^2). A pixel's memory walks on a lattice of one threshold;
  // each half period it passes the points between trough and peak, which for lattices
  // in all positions (a phase for each pixel) are 2 A'/theta, less the one it stands on.
  constexpr double kAmplitude = 0.1;
  constexpr double kThreshold = 0.01;
  constexpr double kMeanIntensity = 100;
  PixelConfig config = only_low_pass(30);
  config.threshold_on_log = config.threshold_off_log = kThreshold;
  const double k = 2 * std::numbers::pi * config.cutoff_hz * (kMeanIntensity + 20) / 275;
  const core::Resolution size{100, 1};
  for (const double hz : {2.0, 13.0, 40.0}) {
    const double omega = 2 * std::numbers::pi * hz;
    const Scene scene = [&](int x, int, double t_s) {
      return kMeanIntensity / 255 * kWhite_lux *
             std::exp(kAmplitude * std::sin(omega * t_s + 0.7 * x));
    };
    EventEmulator emulator(config, size, kWhite_lux, 5);
    constexpr int kPeriods = 40;
    const std::vector<Event> events =
        run(emulator, size, scene, core::from_seconds(kPeriods / hz), Time(1'000));
    const double amplitude = kAmplitude / std::hypot(1, omega / k);
    const double per_swing = static_cast<double>(events.size()) / (2.0 * kPeriods * size.width_px);
    // 100 lattices average to 5 * sqrt(1/12/100) = 0.15 at most; k itself swings by 8 %,
    // which moves the amplitude by about the square of that.
    EXPECT_NEAR(per_swing, 2 * amplitude / kThreshold - 1, 0.15 + 0.01 * per_swing) << hz;
  }
}

TEST(EventEmulator, thresholds_are_recovered_from_the_events) {
  // A log ramp: the time between two events of a pixel is its own threshold over the
  // slope, so mean and deviation of the mismatch come out of the events alone.
  PixelConfig config = ideal();
  config.threshold_on_sigma_log = 0.03;
  config.threshold_off_log = 0.3;
  config.threshold_off_sigma_log = 0.05;
  const core::Resolution size{60, 50};
  constexpr double kSlopePerS = 2.0;
  for (const bool on : {true, false}) {
    const Scene scene = [on](int, int, double t_s) {
      return on ? 0.45 * std::exp(kSlopePerS * t_s) : 4.9 * std::exp(-kSlopePerS * t_s);
    };
    EventEmulator emulator(config, size, kWhite_lux, 6);
    std::map<int, std::pair<Time, Time>> first_two;
    for (const Event& e : run(emulator, size, scene, Time(1'000'000), Time(5'000))) {
      ASSERT_EQ(e.on, on);
      auto& times = first_two[e.y * size.width_px + e.x];
      if (times.first == Time{})
        times.first = e.t;
      else if (times.second == Time{})
        times.second = e.t;
    }
    const double mean = on ? config.threshold_on_log : config.threshold_off_log;
    const double sigma = on ? config.threshold_on_sigma_log : config.threshold_off_sigma_log;
    double sum = 0, squares = 0;
    for (const auto& [pixel, times] : first_two) {
      const double threshold = core::seconds(times.second - times.first) * kSlopePerS;
      sum += threshold;
      squares += (threshold - mean) * (threshold - mean);
      const auto known = on ? emulator.thresholds_on_log() : emulator.thresholds_off_log();
      EXPECT_NEAR(threshold, known[pixel], 3e-5);  // 1 us of rounding is 2e-6, float the rest
    }
    const double n = size.pixels();
    EXPECT_NEAR(sum / n, mean, 5 * sigma / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(squares / n), sigma, 5 * sigma / std::sqrt(2 * n));
  }
}

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

TEST(EventEmulator, signal_is_not_layered_on_the_steps) {
  // One moving edge and mismatched thresholds: nearly every event has its own time.
  PixelConfig config = ideal();
  config.threshold_on_sigma_log = config.threshold_off_sigma_log = 0.03;
  const core::Resolution size{60, 40};
  EventEmulator emulator(config, size, kWhite_lux, 11);
  constexpr int kStepUs = 4'000, kBins = 20;
  std::vector<double> offsets(kBins);
  const auto events = run(emulator, size, edge, Time(600'000), Time(kStepUs));
  for (const Event& e : events)
    ++offsets[static_cast<std::size_t>((e.t.count() - 1) % kStepUs / (kStepUs / kBins))];
  const auto n = static_cast<double>(events.size());
  ASSERT_GT(n, 10'000);
  // The events of a pixel repel each other, so Poisson's 5 sigma is generous.
  for (const double count : offsets) EXPECT_NEAR(count, n / kBins, 5 * std::sqrt(n / kBins));
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

TEST(EventEmulator, unequal_thresholds_give_their_ratio_of_events) {
  // A periodic scene takes the log up as far as down: ON counts times their threshold are
  // OFF counts times theirs, but for one of each a pixel. 0.26/0.15 is a real DAVIS346's.
  PixelConfig config = ideal();
  config.threshold_on_log = 0.26;
  config.threshold_off_log = 0.15;
  const core::Resolution size{30, 20};
  EventEmulator emulator(config, size, kWhite_lux, 22);
  const auto events = run(emulator, size, sine, Time(4'000'000), Time(2'000));
  const auto on = static_cast<double>(std::ranges::count_if(events, &Event::on));
  const double off = static_cast<double>(events.size()) - on;
  EXPECT_NEAR(off / on, 0.26 / 0.15, 0.26 / 0.15 * 2 * size.pixels() / on);
  EXPECT_GT(on / size.pixels(), 80);  // so that the tolerance means something
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

TEST(EventEmulator, agrees_with_the_plain_emulator_in_its_counts) {
  // All effects at once before a moving scene. Draws differ, so that counts agree like
  // Poisson numbers, the signal's better than that; on top of it the thresholds' own
  // mismatch, 0.05 in 0.2 a pixel, which over 10,000 pixels is below half a per cent.
  const core::Resolution size{125, 80};
  const PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  EventEmulator fast(config, size, kWhite_lux, 24);
  test::ScalarEmulator plain(config, size, kWhite_lux, 24);
  const test::MovingTexture scene(kWhite_lux);
  std::vector<Event> fast_events, plain_events;
  for (int i = 0; i < 150; ++i) {
    const auto image = scene.luminance_lux(size, i);
    fast.step(Time(i * 2'300), image, fast_events);
    plain.step(Time(i * 2'300), image, plain_events);
  }
  for (const bool on : {true, false}) {
    const auto is = [on](const Event& e) { return e.on == on; };
    const auto n = static_cast<double>(std::ranges::count_if(fast_events, is));
    const auto expected = static_cast<double>(std::ranges::count_if(plain_events, is));
    ASSERT_GT(expected, 10'000);
    EXPECT_NEAR(n, expected, 5 * std::sqrt(2 * expected) + 0.005 * expected);
  }
}

TEST(EventEmulator, same_seed_same_events_another_seed_others) {
  const core::Resolution size{40, 30};
  const auto events = [&](std::uint64_t seed) {
    EventEmulator emulator(preset_pixel(SensorPreset::dim, 5), size, kWhite_lux, seed);
    return run(emulator, size, edge, Time(200'000), Time(4'000));
  };
  const auto first = events(14);
  EXPECT_GT(first.size(), 1000u);
  EXPECT_EQ(first, events(14));
  EXPECT_NE(first, events(15));
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

TEST(EventEmulator, events_lie_in_the_step_and_are_in_order) {
  const core::Resolution size{70, 50};  // more than one block of pixels, and a rest
  EventEmulator emulator(preset_pixel(SensorPreset::dim, 5), size, kWhite_lux, 18);
  core::Random random = core::random_stream(18, "test");
  Time t(1'000'000), last = t;
  std::vector<Event> none;
  emulator.step(t, picture(size, edge, 0), none);
  EXPECT_TRUE(none.empty());
  for (int i = 0; i < 100; ++i) {
    t += Time(1 + static_cast<int>(9'000 * core::uniform01(random)));
    std::vector<Event> events;
    emulator.step(t, picture(size, edge, core::seconds(t) - 1), events);
    EXPECT_TRUE(std::ranges::is_sorted(events, {},
                                       [](const Event& e) { return std::tuple(e.t, e.y, e.x); }));
    for (const Event& e : events) {
      EXPECT_GT(e.t, last);
      EXPECT_LE(e.t, t);
      EXPECT_LT(e.x, size.width_px);
      EXPECT_LT(e.y, size.height_px);
    }
    last = t;
  }
}

TEST(EventEmulator, refractory_period_is_kept_whatever_fires) {
  PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  config.refractory_us = 7'000;
  config.shot_noise_rate_hz = 50;
  config.hot_pixel_fraction = 0.05;
  const core::Resolution size{40, 30};
  EventEmulator emulator(config, size, kWhite_lux, 19);
  std::map<int, Time> last;
  int shortest_us = 1'000'000;
  for (const Event& e : run(emulator, size, sine, Time(1'000'000), Time(3'000))) {
    const int pixel = e.y * size.width_px + e.x;
    if (last.contains(pixel))
      shortest_us = std::min(shortest_us, static_cast<int>((e.t - last[pixel]).count()));
    last[pixel] = e.t;
  }
  EXPECT_GE(shortest_us, 6'999);  // both ends are rounded up to a microsecond
  EXPECT_LT(shortest_us, 7'100);
}

TEST(EventEmulator, unusable_radiance_is_counted_and_makes_no_events) {
  const core::Resolution size{4, 1};
  EventEmulator emulator(ideal(), size, kWhite_lux, 20);
  std::vector<Event> events;
  core::Image<float> image(size, 2.0f);
  image(3, 0) = 0.0f;
  emulator.step(Time(0), image, events);
  image(0, 0) = std::numeric_limits<float>::quiet_NaN();
  image(1, 0) = std::numeric_limits<float>::infinity();
  image(3, 0) = -1.0f;
  emulator.step(Time(1'000), image, events);
  EXPECT_TRUE(events.empty());
  EXPECT_EQ(emulator.counts().negative_radiance, 1u);
  EXPECT_EQ(emulator.counts().not_finite_radiance, 2u);
}

TEST(EventEmulator, minus_zero_is_plain_zero_for_the_whole_stream) {
  const core::Resolution size{70, 50};  // blocks with and without a -0
  const auto events_with = [&](float zero) {
    EventEmulator emulator(preset_pixel(SensorPreset::dim, 5), size, kWhite_lux, 31);
    std::vector<Event> events;
    for (int i = 0; i < 60; ++i) {
      auto image = picture(size, edge, 0.01 * i);
      for (int x = 0; x < size.width_px; x += 9) image(x, 7 * (i % 7)) = zero;
      emulator.step(Time(10'000 * i), image, events);
    }
    EXPECT_EQ(emulator.counts().negative_radiance, 0u);
    return events;
  };
  const auto plain = events_with(0.0f);
  EXPECT_GT(plain.size(), 1000u);
  EXPECT_EQ(events_with(-0.0f), plain);
}

TEST(EventEmulator, values_to_be_corrected_leave_their_neighbours_as_they_are) {
  // Far above white, where the scale takes the intensity beyond any limit of the input,
  // beside a NaN.
  const core::Resolution size{300, 1};
  const auto events_with = [&](float last) {
    EventEmulator emulator(ideal(), size, 1e-3, 32);
    std::vector<Event> events;
    core::Image<float> image(size, 1e15f);
    emulator.step(Time(0), image, events);
    std::ranges::fill(image.pixels(), 1e16f);
    image(299, 0) = last;
    emulator.step(Time(5'000), image, events);
    return events;
  };
  const auto held = events_with(1e15f);
  EXPECT_EQ(held.size(), 299u * 11);  // ln 10 / 0.2
  EXPECT_EQ(events_with(std::numeric_limits<float>::quiet_NaN()), held);
}

/// Log of an intensity with the presets' knee at 20, and the way back.
double knee_log(double intensity) { return ScalarPixel::log_intensity(intensity, 20); }
double of_knee_log(double log) {
  return log <= std::log(20.0) ? log * 20 / std::log(20.0) : std::exp(log);
}

/// From `i0` to `i1` in `ramp_s`, straight in the log, then still: the photoreceptor's
/// output at each microsecond, by Runge and Kutta's method with a rate constant that
/// follows the intensity all the way.
std::vector<double> true_output(double i0, double i1, double ramp_s, double cutoff_hz) {
  const double from = knee_log(i0), change = knee_log(i1) - from;
  const auto slope = [&](double t_s, double output) {
    const double log = from + change * std::min(1.0, t_s / ramp_s);
    return 2 * std::numbers::pi * cutoff_hz * (of_knee_log(log) + 20) / 275 * (log - output);
  };
  std::vector<double> outputs{from};
  constexpr double kStepS = 1e-6;
  for (int us = 0; us < 66'000; ++us) {
    const double t_s = us * kStepS, p = outputs.back();
    const double a = slope(t_s, p), b = slope(t_s + kStepS / 2, p + a * kStepS / 2);
    const double c = slope(t_s + kStepS / 2, p + b * kStepS / 2);
    const double d = slope(t_s + kStepS, p + c * kStepS);
    outputs.push_back(p + kStepS / 6 * (a + 2 * b + 2 * c + d));
  }
  return outputs;
}

/// How far the events, added up, are off the true output at most: at each event, and at the
/// end by more than a threshold.
double worst_off(const std::vector<Event>& events, const std::vector<double>& truth,
                 double threshold) {
  double memory = truth.front(), worst = 0;
  for (const Event& e : events) {
    memory += e.on ? threshold : -threshold;
    worst = std::max(worst, std::abs(memory - truth[static_cast<std::size_t>(e.t.count())]));
  }
  return std::max(worst, std::abs(memory - truth.back()) - threshold);
}

TEST(EventEmulator, low_pass_is_right_whatever_the_step) {
  // `dim`, noise-free, fine thresholds; the light is straight in the log over each step, so
  // that all that is off is the photoreceptor. The rate constant is taken at its mean over a
  // step or part of one, which is wrong in the second order of the part: the tolerances are
  // a fifth above what was measured, or half where it is large. In one 5 ms step k dt is
  // 0.94 at white and there is one part: the worst case.
  struct Case {
    double from, to;
    int ramp_us, step_us;
    double tolerance;
  };
  PixelConfig config = only_low_pass(30);
  config.threshold_on_log = config.threshold_off_log = 0.01;
  for (const Case& c : {Case{250, 22, 33'000, 1'000, 0.0007},
                        {250, 22, 33'000, 33'000, 0.012},
                        {250, 22, 30'000, 5'000, 0.012},
                        {250, 22, 5'000, 5'000, 0.15},
                        {22, 250, 33'000, 1'000, 0.0007},
                        {22, 250, 33'000, 33'000, 0.018},
                        {22, 250, 30'000, 5'000, 0.02},
                        {22, 250, 5'000, 5'000, 0.15},
                        {250, 2, 33'000, 33'000, 0.04},
                        {2, 250, 33'000, 33'000, 0.14}}) {
    const double ramp_s = 1e-6 * c.ramp_us;
    EventEmulator emulator(config, {1, 1}, kWhite_lux, 33);
    const Scene scene = [&](int, int, double t_s) {
      const double way = std::min(1.0, t_s / ramp_s);
      const double log = knee_log(c.from) + (knee_log(c.to) - knee_log(c.from)) * way;
      return of_knee_log(log) * kWhite_lux / 255;
    };
    const auto events = run(emulator, {1, 1}, scene, Time(66'000), Time(c.step_us));
    ASSERT_GT(events.size(), 100u);
    auto truth = true_output(c.from, c.to, ramp_s, 30);
    truth.resize(static_cast<std::size_t>(66'000 / c.step_us * c.step_us) + 1);
    const double off = worst_off(events, truth, 0.01);
    EXPECT_LT(off, c.tolerance) << c.from << " to " << c.to << " in " << c.ramp_us
                                << " us, steps of " << c.step_us << " us";
  }
}

TEST(EventEmulator, a_step_in_parts_is_one_step_to_everyone_else) {
  // 33 ms take seven parts in `dim`. What had to be corrected counts once, events are in
  // order, and noise comes as in steps of 1 ms.
  const core::Resolution size{40, 30};
  PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  config.leak_rate_hz = 0;
  EventEmulator coarse(config, size, kWhite_lux, 34), fine(config, size, kWhite_lux, 34);
  EXPECT_EQ(run(coarse, size, still(2), Time(990'000), Time(33'000)),
            run(fine, size, still(2), Time(990'000), Time(1'000)));

  EventEmulator emulator(config, size, kWhite_lux, 35);
  std::vector<Event> events;
  emulator.step(Time(0), picture(size, edge, 0), events);
  auto image = picture(size, edge, 0.2);
  image(0, 0) = std::numeric_limits<float>::quiet_NaN();
  image(1, 0) = -1.0f;
  image(2, 0) = -0.0f;
  EXPECT_THROW(emulator.step(Time(0), image, events), std::invalid_argument);
  emulator.step(Time(33'000), image, events);
  EXPECT_EQ(emulator.counts().not_finite_radiance, 1u);
  EXPECT_EQ(emulator.counts().negative_radiance, 1u);
  EXPECT_GT(events.size(), 100u);
  EXPECT_TRUE(
      std::ranges::is_sorted(events, {}, [](const Event& e) { return std::tuple(e.t, e.y, e.x); }));
  const auto is_nan_pixel = [](const Event& e) { return e.x == 0 && e.y == 0; };
  EXPECT_LE(std::ranges::count_if(events, is_nan_pixel), 2);  // its value holds: noise alone

  // The longest step and the fastest photoreceptor there are.
  config.cutoff_hz = 1e5;
  EventEmulator fast(config, size, kWhite_lux, 36);
  events.clear();
  fast.step(Time(0), picture(size, edge, 0), events);
  for (const Time t : {Time(1), Time(3), Time(6), Time(100), Time(1'000'000)})
    fast.step(t, picture(size, edge, core::seconds(t)), events);
  EXPECT_TRUE(
      std::ranges::is_sorted(events, {}, [](const Event& e) { return std::tuple(e.t, e.y, e.x); }));
}

TEST(EventEmulator, wrong_input_is_refused_and_leaves_no_trace) {
  const core::Resolution size{4, 3};
  EXPECT_THROW(EventEmulator(ideal(), {0, 3}, kWhite_lux, 1), std::invalid_argument);
  EXPECT_THROW(EventEmulator(ideal(), size, 0, 1), std::invalid_argument);
  PixelConfig bad = ideal();
  bad.threshold_on_log = 0;
  EXPECT_THROW(EventEmulator(bad, size, kWhite_lux, 1), std::invalid_argument);
  bad = ideal();
  bad.log_linear_below = 1;
  EXPECT_THROW(EventEmulator(bad, size, kWhite_lux, 1), std::invalid_argument);

  EventEmulator emulator(ideal(), size, kWhite_lux, 1);
  std::vector<Event> events;
  emulator.step(Time(1'000), core::Image<float>(size, 1.0f), events);
  EXPECT_THROW(emulator.step(Time(2'000), core::Image<float>({3, 4}, 2.0f), events),
               std::invalid_argument);
  EXPECT_THROW(emulator.step(Time(1'000), core::Image<float>(size, 2.0f), events),
               std::invalid_argument);
  EXPECT_THROW(
      emulator.step(Time(1'000) + std::chrono::hours(2), core::Image<float>(size, 2.0f), events),
      std::invalid_argument);
  EXPECT_TRUE(events.empty());
  emulator.step(Time(2'000), core::Image<float>(size, 1.0f), events);
  EXPECT_TRUE(events.empty());
}

}  // namespace
}  // namespace nightjar::sim
