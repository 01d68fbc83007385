#include "sim/emulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/random.h"
#include "tests/support/sim_emulator_scenes.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;
using namespace test;

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
