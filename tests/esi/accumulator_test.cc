#include "esi/accumulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/esi_plain_accumulator.h"
#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

core::Image<std::uint8_t> picture_of(Accumulator& accumulator, core::Time t) {
  core::Picture picture;
  accumulator.render(t, picture);
  return picture.gray;
}

int gray_at(Accumulator& accumulator, int x, int y, core::Time t) {
  return picture_of(accumulator, t)(x, y);
}

int gray_of(double potential) { return static_cast<int>(std::lround(255 * potential)); }

AccumulatorConfig config_of(AccumulatorDecay decay) {
  AccumulatorConfig config;
  config.decay = decay;
  return config;
}

void process(Accumulator& accumulator, std::vector<core::Event> events) {
  accumulator.process(events);
}

TEST(Accumulator, StartsAtNeutral) {
  Accumulator black({}, kSensor);
  EXPECT_EQ(gray_at(black, 3, 4, 0s), 0);
  AccumulatorConfig config;
  config.neutral = 0.5;
  Accumulator middle(config, kSensor);
  EXPECT_EQ(gray_at(middle, 3, 4, 1s), gray_of(0.5));
}

TEST(Accumulator, HandWorkedExponentialDecay) {
  Accumulator accumulator({}, kSensor);  // tau 1 s, 0.15 an event
  process(accumulator, {{100ms, 1, 1, true}, {600ms, 1, 1, true}});
  const double potential = 0.15 * std::exp(-0.5) + 0.15;
  EXPECT_EQ(gray_at(accumulator, 1, 1, 600ms), gray_of(potential));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1600ms), gray_of(potential * std::exp(-1.0)));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 600ms), gray_of(potential));  // looking changed nothing
}

TEST(Accumulator, HandWorkedLinearDecayTowardsNeutralFromEitherSide) {
  AccumulatorConfig config = config_of(AccumulatorDecay::linear);
  config.neutral = 0.5;
  config.decay_per_s = 0.2;
  Accumulator accumulator(config, kSensor);
  process(accumulator, {{100ms, 1, 1, true}, {100ms, 2, 1, false}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 600ms), gray_of(0.65 - 0.1));
  EXPECT_EQ(gray_at(accumulator, 2, 1, 600ms), gray_of(0.35 + 0.1));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 10s), gray_of(0.5));
  EXPECT_EQ(gray_at(accumulator, 2, 1, 10s), gray_of(0.5));
  process(accumulator, {{600ms, 1, 1, true}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 600ms), gray_of(0.65 - 0.1 + 0.15));
}

TEST(Accumulator, WithoutDecayKeepsAll) {
  Accumulator accumulator(config_of(AccumulatorDecay::none), kSensor);
  process(accumulator, {{1s, 1, 1, true}, {50s, 1, 1, true}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1000s), gray_of(0.3));
}

TEST(Accumulator, StepDecayBeginsAnewWithTheFirstEventAfterAPicture) {
  Accumulator accumulator(config_of(AccumulatorDecay::step), kSensor);
  process(accumulator, {{1ms, 1, 1, true}, {2ms, 1, 1, true}});
  process(accumulator, {{3ms, 1, 1, true}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 10ms), gray_of(0.45));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 11ms), gray_of(0.45));  // looking again
  process(accumulator, {{12ms, 2, 2, true}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 12ms), 0);
  EXPECT_EQ(gray_at(accumulator, 2, 2, 12ms), gray_of(0.15));
}

TEST(Accumulator, StaysWithinItsBounds) {
  AccumulatorConfig config = config_of(AccumulatorDecay::none);
  config.least = -0.5;
  config.greatest = 0.3;
  Accumulator accumulator(config, kSensor);
  std::vector<core::Event> events;
  for (int i = 0; i < 10; ++i) events.push_back({i * 1ms, 1, 1, true});
  for (int i = 0; i < 10; ++i) events.push_back({i * 1ms + 10ms, 2, 1, false});
  accumulator.process(events);
  EXPECT_EQ(gray_at(accumulator, 1, 1, 20ms), 255);
  EXPECT_EQ(gray_at(accumulator, 2, 1, 20ms), 0);
  process(accumulator, {{20ms, 1, 1, false}, {20ms, 2, 1, true}});  // at once off the bounds
  EXPECT_EQ(gray_at(accumulator, 1, 1, 20ms), gray_of((0.8 - 0.15) / 0.8));
  EXPECT_EQ(gray_at(accumulator, 2, 1, 20ms), gray_of(0.15 / 0.8));
}

TEST(Accumulator, IgnoringPolarityMakesAnEdgeMap) {
  // dv-processing's EdgeMapAccumulator: 0.25 an event of either polarity, reset each frame.
  AccumulatorConfig config = config_of(AccumulatorDecay::step);
  config.ignore_polarity = true;
  config.contribution = 0.25;
  Accumulator accumulator(config, kSensor);
  process(accumulator, {{1ms, 1, 1, true}, {2ms, 2, 1, false}, {3ms, 2, 1, false}});
  EXPECT_EQ(gray_at(accumulator, 1, 1, 3ms), gray_of(0.25));
  EXPECT_EQ(gray_at(accumulator, 2, 1, 3ms), gray_of(0.5));
}

TEST(Accumulator, SynchronousDecayComesWithThePicturesAlone) {
  AccumulatorConfig config;
  config.synchronous_decay = true;
  Accumulator accumulator(config, kSensor);
  process(accumulator, {{100ms, 1, 1, true}, {900ms, 1, 1, true}});  // no decay in between
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1s), gray_of(0.3 * std::exp(-1.0)));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1s), gray_of(0.3 * std::exp(-1.0)));  // again
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1500ms), gray_of(0.3 * std::exp(-1.5)));
  EXPECT_EQ(gray_at(accumulator, 1, 1, 1200ms), gray_of(0.3 * std::exp(-1.5)));  // not back
}

TEST(Accumulator, AgreesWithThePlainOneWithinAGreyLevel) {
  const auto events = test::random_events(kSensor, 20000, 10s, /*seed=*/8);
  for (const auto& [name, decay] : kAccumulatorDecays)
    for (const bool synchronous : {false, true})
      for (const double neutral : {0.0, 0.4})
        for (const double rate : {0.01, 1.0, 30.0}) {
          AccumulatorConfig config = config_of(decay);
          config.synchronous_decay = synchronous;
          config.neutral = neutral;
          config.decay_per_s = rate;
          config.decay_time_s = 1 / rate;
          Accumulator fast(config, kSensor);
          test::PlainAccumulator plain(config, kSensor);
          core::Time shown{};
          for (const core::Event& e : events) {
            for (; shown + 1s < e.t; shown += 1s) {
              const auto gray = picture_of(fast, shown + 1s);
              const auto expected = plain.picture(shown + 1s);
              for (std::size_t i = 0; i < gray.pixels().size(); ++i)
                // Floats: a value may lie on the edge between two levels.
                ASSERT_NEAR(gray.pixels()[i], expected.pixels()[i], 1) << name << ' ' << rate;
            }
            fast.process({&e, 1});
            plain.process(e);
          }
        }
}

TEST(Accumulator, RefusesAConfigOutOfRange) {
  const auto refuses = [](auto change) {
    AccumulatorConfig config;
    change(config);
    EXPECT_THROW(Accumulator(config, kSensor), std::invalid_argument);
  };
  refuses([](auto& c) { c.contribution = 0; });
  refuses([](auto& c) { c.decay_time_s = -1; });
  refuses([](auto& c) { c.least = 1; });
  refuses([](auto& c) { c.neutral = 1.1; });
  refuses([](auto& c) { c.neutral = -0.1; });
}

}  // namespace
}  // namespace nightjar::esi
