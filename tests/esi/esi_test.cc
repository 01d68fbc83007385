#include "esi/esi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

int gray_at(Esi& esi, int x, int y, core::Time t) {
  core::Picture picture;
  esi.render(t, picture);
  return picture.gray(x, y);
}

/// Eq. 14 for a sum within [-1, 1].
int gray_of(double sum) { return static_cast<int>(std::lround(255.0 * (sum + 1.0) / 2.0)); }

/// Algorithm 2 as it is printed, in doubles, on a map: the reference.
core::Image<std::uint8_t> by_the_listing(const EsiConfig& c,
                                         const std::vector<core::Event>& events) {
  std::map<std::pair<int, int>, std::pair<double, double>> s_and_t;
  for (const core::Event& e : events) {
    auto& [s, t] = s_and_t[{e.x, e.y}];
    s += (e.on ? 1 : -1) * c.contrast_log;
    const double dt = core::seconds(e.t) - t;
    s *= std::max(std::pow(std::max(1.0 - c.decay_rate_hz * dt, 0.0), c.decay_power), 0.0);
    t = core::seconds(e.t);
    s = std::min(std::max(s, c.least_log), c.greatest_log);
  }
  core::Image<std::uint8_t> gray(kSensor);
  for (int y = 0; y < kSensor.height_px; ++y)
    for (int x = 0; x < kSensor.width_px; ++x) {
      const double s = s_and_t[{x, y}].first;
      gray(x, y) = static_cast<std::uint8_t>(
          std::lround(255.0 * (s - c.least_log) / (c.greatest_log - c.least_log)));
    }
  return gray;
}

TEST(Esi, StartsAtTheMiddleGrey) {
  Esi esi({}, kSensor);
  EXPECT_EQ(gray_at(esi, 3, 4, 0s), gray_of(0.0));
}

TEST(Esi, AnEventIsAddedBeforeTheDecaySoALateOneWipesItself) {
  // k = 1 Hz: an event 1 s or more after its predecessor leaves nothing, itself included.
  Esi esi({}, kSensor);
  esi.process(std::vector<core::Event>{{1100ms, 3, 4, true}});
  EXPECT_EQ(gray_at(esi, 3, 4, 1100ms), gray_of(0.0));
}

TEST(Esi, HandWorkedSequence) {
  EsiConfig config;
  config.contrast_log = 0.2;
  config.decay_rate_hz = 2.0;
  config.decay_power = 2.0;
  Esi esi(config, kSensor);
  esi.process(std::vector<core::Event>{{100ms, 1, 1, true},     // 0.2 (1 - 0.2)^2 = 0.128
                                       {200ms, 1, 1, true},     // 0.328 * 0.64 = 0.20992
                                       {300ms, 1, 1, false}});  // 0.00992 * 0.64 = 0.0063488
  EXPECT_EQ(gray_at(esi, 1, 1, 300ms), gray_of(0.0063488));
  esi.process(std::vector<core::Event>{{400ms, 1, 1, true}});  // 0.2063488 * 0.64 = 0.13206
  EXPECT_EQ(gray_at(esi, 1, 1, 400ms), gray_of(0.13206));
}

TEST(Esi, NothingDecaysBetweenTheLastEventAndThePicture) {
  Esi esi({}, kSensor);
  esi.process(std::vector<core::Event>{{100ms, 3, 4, true}});
  EXPECT_EQ(gray_at(esi, 3, 4, 100ms), gray_at(esi, 3, 4, 50s));
}

TEST(Esi, ClampHoldsAHotPixelAndAnswersAtOnceWhenItTurns) {
  Esi esi({}, kSensor);
  std::vector<core::Event> hot;
  for (int i = 1; i <= 1000; ++i) hot.push_back({i * 1ms, 5, 5, true});
  esi.process(hot);
  EXPECT_EQ(gray_at(esi, 5, 5, 1s), 255);
  esi.process(std::vector<core::Event>{{1001ms, 5, 5, false}});
  EXPECT_EQ(gray_at(esi, 5, 5, 1001ms), gray_of((1.0 - 0.2) * 0.999));
}

TEST(Esi, AgreesWithTheListingWithinAGreyLevel) {
  for (const double rate_hz : {0.0, 0.5, 2.0})
    for (const double power : {0.5, 1.0, 2.5}) {
      EsiConfig config;
      config.decay_rate_hz = rate_hz;
      config.decay_power = power;
      const auto events = test::random_events(kSensor, 40000, 20s, /*seed=*/3);
      Esi esi(config, kSensor);
      esi.process(events);
      core::Picture picture;
      esi.render(20s, picture);
      const auto expected = by_the_listing(config, events);
      for (int y = 0; y < kSensor.height_px; ++y)
        for (int x = 0; x < kSensor.width_px; ++x)
          // Sums are floats: only a value on the edge between two levels may differ.
          ASSERT_NEAR(picture.gray(x, y), expected(x, y), 1) << rate_hz << ' ' << power;
    }
}

TEST(Esi, ManyShortIntervalsDecayLessThanOneLong) {
  // Eq. 6 as the paper uses it: a busy pixel keeps more than a quiet one. ON and OFF in
  // turn add nothing but keep the pixel busy.
  Esi busy({}, kSensor), quiet({}, kSensor);
  std::vector<core::Event> rise;
  for (int i = 1; i <= 5; ++i) rise.push_back({i * 1ms, 2, 2, true});
  busy.process(rise);
  quiet.process(rise);
  for (int i = 1; i <= 8; ++i)
    busy.process(std::vector<core::Event>{{5ms + i * 100ms, 2, 2, i % 2 == 0}});
  quiet.process(std::vector<core::Event>{{705ms, 2, 2, false}, {805ms, 2, 2, true}});
  EXPECT_GT(gray_at(busy, 2, 2, 805ms), gray_at(quiet, 2, 2, 805ms));
}

TEST(Esi, DecayRemovesTheGhostWhereADiscStarted) {
  // Fig. 2 of the paper in one line of pixels: a dark bar starts at x = 2 and moves on to
  // x = 12; where it was, pixels brighten by its contrast and stay so without decay. Noise
  // of 5 Hz a pixel, as in dim light, gives the decay its occasions.
  EsiConfig kept;
  kept.decay_rate_hz = 0;
  EsiConfig decaying;
  decaying.decay_rate_hz = 1.0;
  std::vector<core::Event> events;
  for (int i = 0; i < 6; ++i) events.push_back({10ms + i * 1ms, 2, 5, true});
  for (int i = 0; i < 25; ++i) events.push_back({200ms + i * 200ms, 2, 5, i % 2 == 0});
  Esi with_ghost(kept, kSensor), without(decaying, kSensor);
  with_ghost.process(events);
  without.process(events);
  EXPECT_GT(gray_at(with_ghost, 2, 5, 6s), gray_of(0.85));
  EXPECT_NEAR(gray_at(without, 2, 5, 6s), gray_of(0.0), gray_of(0.2) - gray_of(0.0));
}

TEST(Esi, RefusesAConfigOutOfRange) {
  EsiConfig config;
  config.decay_power = -1;
  EXPECT_THROW(Esi(config, kSensor), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::esi
