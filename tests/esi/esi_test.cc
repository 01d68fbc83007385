#include "esi/esi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.h"
#include "esi/esi_reference.h"
#include "tests/support/events.h"
#include "tests/support/poisson_events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

core::Image<std::uint8_t> picture_of(Esi& esi, core::Time t) {
  core::Picture picture;
  esi.render(t, picture);
  return picture.gray;
}

int gray_at(Esi& esi, int x, int y, core::Time t) { return picture_of(esi, t)(x, y); }

/// Eq. 14 for a sum within [-1, 1].
int gray_of(double sum) { return static_cast<int>(std::lround(255.0 * (sum + 1.0) / 2.0)); }

std::vector<PackedEvent> packed(const std::vector<core::Event>& events, core::Resolution size) {
  std::vector<PackedEvent> all;
  for (const core::Event& e : events) all.push_back(pack(e, size.width_px));
  return all;
}

void expect_as_the_reference(const EsiConfig& config, const std::vector<core::Event>& events,
                             core::Resolution size, core::Time t) {
  Esi esi(config, size);
  EsiReference reference(config, size);
  esi.process(events);
  reference.process(packed(events, size));
  const auto gray = picture_of(esi, t);
  const auto expected = reference.picture(t);
  int worst = 0;
  for (std::size_t i = 0; i < gray.pixels().size(); ++i)
    worst = std::max(worst, std::abs(gray.pixels()[i] - expected.pixels()[i]));
  // Issue 4: within one grey level, since a value may lie on the edge between two.
  ASSERT_LE(worst, 1) << "k " << config.decay_rate_hz << " b " << config.decay_power;
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

TEST(Esi, AnEventAddedAfterTheDecayStays) {
  EsiConfig config;
  config.order = EsiOrder::decay_then_add;
  Esi esi(config, kSensor);
  esi.process(std::vector<core::Event>{{1100ms, 3, 4, true}});
  EXPECT_EQ(gray_at(esi, 3, 4, 1100ms), gray_of(0.2));
  esi.process(std::vector<core::Event>{{1600ms, 3, 4, true}});  // 0.2 (1 - 0.5) + 0.2
  EXPECT_EQ(gray_at(esi, 3, 4, 1600ms), gray_of(0.3));
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

TEST(Esi, DecayAtThePictureShowsItAndKeepsTheState) {
  EsiConfig config;
  config.order = EsiOrder::decay_then_add;
  config.decay_at_picture = true;
  Esi esi(config, kSensor);
  esi.process(std::vector<core::Event>{{100ms, 3, 4, true}});
  EXPECT_EQ(gray_at(esi, 3, 4, 600ms), gray_of(0.1));
  EXPECT_EQ(gray_at(esi, 3, 4, 50s), gray_of(0.0));
  EXPECT_EQ(gray_at(esi, 3, 4, 100ms), gray_of(0.2));
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
  const auto events = test::random_events(kSensor, 40000, 20s, /*seed=*/3);
  for (const double rate_hz : {0.0, 1e-7, 0.01, 0.5, 2.0, 30.0, 1000.0})
    for (const double power : {0.01, 0.5, 1.0, 2.5, 20.0})
      for (const EsiOrder order : {EsiOrder::add_then_decay, EsiOrder::decay_then_add})
        for (const bool at_picture : {false, true}) {
          EsiConfig config;
          config.decay_rate_hz = rate_hz;
          config.decay_power = power;
          config.order = order;
          config.decay_at_picture = at_picture;
          expect_as_the_reference(config, events, kSensor, 20010ms);
        }
}

TEST(Esi, AgreesWithTheListingOverAMillionEventsOfAHotPixel) {
  // Rounding that favours one side would add up to many grey levels.
  core::Random random = core::random_stream(/*seed=*/4, "test.esi.hot");
  std::vector<core::Event> events;
  for (int i = 1; i <= 1'000'000; ++i)
    events.push_back({i * 20us, 1, 1, core::uniform01(random) < 0.5004});
  for (const double power : {0.5, 1.0, 2.5}) {
    EsiConfig config;
    config.contrast_log = 0.01;
    config.decay_rate_hz = 0.5;
    config.decay_power = power;
    expect_as_the_reference(config, events, kSensor, 20s);
  }
}

TEST(Esi, ManyShortIntervalsDecayLessThanOneLong) {
  // Eq. 6: d(t)^n > d(n t) for t < 1/(n k), which the paper calls adapting to the rate of
  // events. ON and OFF in turn keep a pixel busy; here they are too small to be seen.
  EsiConfig config;
  config.order = EsiOrder::decay_then_add;
  for (const double power : {0.5, 1.0, 2.5})
    for (const int n : {2, 3, 8, 20}) {
      config.decay_power = power;
      Esi busy(config, kSensor), quiet(config, kSensor);
      std::vector<core::Event> rise;
      for (int i = 0; i < 5; ++i) rise.push_back({0s, 2, 2, true});
      for (Esi* each : {&busy, &quiet}) each->process(rise);
      const core::Time t = 900ms / n;
      for (int i = 1; i <= n; ++i)  // ON and OFF cancel within an instant
        busy.process(std::vector<core::Event>{{i * t, 2, 2, false}, {i * t, 2, 2, true}});
      quiet.process(std::vector<core::Event>{{n * t, 2, 2, false}, {n * t, 2, 2, true}});
      const double short_ones = std::pow(1 - core::seconds(t), power * n);
      const double long_one = std::pow(1 - core::seconds(n * t), power);
      EXPECT_NEAR(gray_at(busy, 2, 2, 1s), gray_of(short_ones), 1) << n << ' ' << power;
      EXPECT_NEAR(gray_at(quiet, 2, 2, 1s), gray_of(long_one), 1) << n << ' ' << power;
      EXPECT_GT(gray_at(busy, 2, 2, 1s), gray_at(quiet, 2, 2, 1s)) << n << ' ' << power;
    }
}

/// Fig. 2 of the paper: brightness rises linearly along x, a disc of 30 % reflectivity
/// moves towards -x. Events come from the log intensity as it is, one for each 0.2 it moves.
class DiscOnARamp {
 public:
  static constexpr core::Resolution kSize{64, 32};
  static constexpr core::Time kEnd = 2s;
  static constexpr double kContrast = 0.2;

  static double centre_x(double t_s) { return 48.0 - 16.0 * t_s; }

  static bool covered(int x, int y, double t_s) {
    const double dx = x - centre_x(t_s), dy = y - 16.0;
    return dx * dx + dy * dy < 64.0;
  }

  static double log_intensity(int x, int y, double t_s) {
    return std::log((10.0 + x) * (covered(x, y, t_s) ? 0.3 : 1.0));
  }

  static std::vector<core::Event> events() {
    std::vector<core::Event> all;
    core::Image<double> memorised(kSize);
    for (int y = 0; y < kSize.height_px; ++y)
      for (int x = 0; x < kSize.width_px; ++x) memorised(x, y) = log_intensity(x, y, 0);
    for (core::Time t = 1ms; t <= kEnd; t += 1ms)
      for (int y = 0; y < kSize.height_px; ++y)
        for (int x = 0; x < kSize.width_px; ++x) fire(t, x, y, memorised(x, y), all);
    return all;
  }

 private:
  static void fire(core::Time t, int x, int y, double& memorised, std::vector<core::Event>& all) {
    const double now = log_intensity(x, y, core::seconds(t));
    for (; now - memorised >= kContrast; memorised += kContrast)
      all.push_back({t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), true});
    for (; memorised - now >= kContrast; memorised -= kContrast)
      all.push_back({t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), false});
  }
};

/// Mean grey level where the disc is at `t_s` and not at `but_s`.
double disc_gray(const core::Image<std::uint8_t>& gray, double t_s, double but_s) {
  double sum = 0, count = 0;
  for (int y = 0; y < gray.height(); ++y)
    for (int x = 0; x < gray.width(); ++x)
      if (DiscOnARamp::covered(x, y, t_s) && !DiscOnARamp::covered(x, y, but_s)) {
        sum += gray(x, y);
        ++count;
      }
  return sum / count;
}

EsiConfig ramp_config(double rate_hz) {
  EsiConfig config;
  config.contrast_log = DiscOnARamp::kContrast;
  config.decay_rate_hz = rate_hz;
  config.least_log = -2;
  config.greatest_log = 2;
  return config;
}

TEST(Esi, WithoutDecayShowsTheDiscAndItsReversedGhostWhereItStarted) {
  Esi esi(ramp_config(0), DiscOnARamp::kSize);
  esi.process(DiscOnARamp::events());
  const auto gray = picture_of(esi, DiscOnARamp::kEnd);
  // log 0.3 = -1.204 of the range of 4: 77 levels below the middle for the disc, as many
  // above for the ghost, but for the threshold's part that is not reached (13 levels).
  EXPECT_NEAR(disc_gray(gray, 2.0, 0.0), 127.5 - 76.7, 13);
  EXPECT_NEAR(disc_gray(gray, 0.0, 2.0), 127.5 + 76.7, 13);
}

TEST(Esi, DecayRemovesTheGhostGivenNoiseAndKeepsTheDisc) {
  // Noise of 5 Hz a pixel, as in dim light, gives the decay its occasions.
  auto events = DiscOnARamp::events();
  const core::Image<double> rates(DiscOnARamp::kSize, 5.0);
  const auto noise = test::poisson_events(rates, 5.0, 0.5, DiscOnARamp::kEnd, /*seed=*/5);
  events.insert(events.end(), noise.begin(), noise.end());
  std::ranges::stable_sort(events, {}, &core::Event::t);
  Esi kept(ramp_config(0), DiscOnARamp::kSize), decaying(ramp_config(1.5), DiscOnARamp::kSize);
  kept.process(events);
  decaying.process(events);
  const auto with_ghost = picture_of(kept, DiscOnARamp::kEnd);
  const auto without = picture_of(decaying, DiscOnARamp::kEnd);
  // exp(-1.5/s * 1.5 s), on average since the disc left, is a tenth, and eq. 6 makes it less.
  EXPECT_GT(disc_gray(with_ghost, 0.0, 2.0) - 127.5, 55);
  EXPECT_LT(disc_gray(without, 0.0, 2.0) - 127.5, 20);
  EXPECT_LT(disc_gray(without, 2.0, 0.0) - 127.5, -30);
}

TEST(Esi, AgreesWithTheListingOnTheDisc) {
  for (const double power : {0.5, 1.0, 2.5}) {
    EsiConfig config = ramp_config(1.5);
    config.decay_power = power;
    expect_as_the_reference(config, DiscOnARamp::events(), DiscOnARamp::kSize, DiscOnARamp::kEnd);
  }
}

/// Fig. 4: the mean of log(1 + |S| / C) after 2 s of a scene that does not move, with noise
/// of 5 Hz in each pixel, from the grey levels of a picture.
double noise_figure(double rate_hz) {
  const core::Resolution size{64, 48};
  EsiConfig config;
  config.contrast_log = 0.15;  // "considering the threshold is 15 %"
  config.decay_rate_hz = rate_hz;
  config.least_log = -10;
  config.greatest_log = 10;
  Esi esi(config, size);
  const core::Image<double> rates(size, 5.0);
  esi.process(test::poisson_events(rates, 5.0, 0.5, 2s, /*seed=*/6));
  const core::Image<std::uint8_t> picture = picture_of(esi, 2s);
  double sum = 0;
  for (const std::uint8_t level : picture.pixels())
    sum += std::log(1 + std::abs(level / 255.0 * 20.0 - 10.0) / config.contrast_log);
  return sum / size.pixels();
}

TEST(Esi, NoiseOfAStaticSceneAddsUpWithoutDecayAndLessWithIt) {
  // The difference of two Poisson counts of mean 5 each: mean of log(1 + |n|) is 1.09
  // (summed over its distribution). A grey level is half a threshold: within 0.1.
  EXPECT_NEAR(noise_figure(0), 1.09, 0.1);
  EXPECT_LT(noise_figure(1), 0.9 * noise_figure(0));
  EXPECT_LT(noise_figure(3), 0.75 * noise_figure(0));
}

TEST(Esi, RefusesAConfigOutOfRange) {
  const auto refuses = [](auto change) {
    EsiConfig config;
    change(config);
    EXPECT_THROW(Esi(config, kSensor), std::invalid_argument);
  };
  refuses([](auto& c) { c.decay_power = -1; });
  refuses([](auto& c) { c.decay_rate_hz = -1; });
  refuses([](auto& c) { c.decay_rate_hz = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](auto& c) { c.least_log = 0.5; });
  refuses([](auto& c) { c.contrast_log = 0; });
}

}  // namespace
}  // namespace nightjar::esi
