#include "sim/emulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "core/random.h"
#include "tests/support/sim_emulator_scenes.h"
#include "tests/support/sim_moving_texture.h"
#include "tests/support/sim_scalar_emulator.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;
using namespace test;

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

}  // namespace
}  // namespace nightjar::sim
