// What EDI and FEDI share; what they do differently is in their own tests.
#include "esi/double_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "esi/edi.h"
#include "esi/fedi.h"
#include "tests/support/esi_double_integral_scenes.h"
#include "tests/support/events.h"
#include "tests/support/frames.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;
using Gray = core::Image<std::uint8_t>;

constexpr core::Resolution kSensor{16, 12};

int gray_of(double latent) {
  return static_cast<int>(std::lround(255 * std::clamp(latent, 0.0, 1.0)));
}

template <class Method>
class DoubleIntegralTest : public testing::Test {
 protected:
  static DoubleIntegralConfig fixed(double contrast_log) {
    DoubleIntegralConfig config;
    config.search_contrast = false;
    config.contrast_log = contrast_log;
    return config;
  }
  static Gray picture_of(Reconstructor& method, core::Time t) {
    core::Picture picture;
    method.render(t, picture);
    return picture.gray;
  }
};

using Methods = testing::Types<Edi, Fedi>;
TYPED_TEST_SUITE(DoubleIntegralTest, Methods);

TYPED_TEST(DoubleIntegralTest, AgreesWithTheEquations) {
  for (const double c : {0.05, 0.2, 1.0})
    for (const int bits : {8, 10}) {
      const auto events = test::random_events(kSensor, 4000, 1s, /*seed=*/3);
      const auto exposed = test::random_frame(kSensor, 300ms, 800ms, bits, /*seed=*/2);
      TypeParam method(this->fixed(c), kSensor);
      method.process(events);
      method.add_frame(exposed);
      const Gray gray = this->picture_of(method, 1s);
      const test::DoubleIntegralByTheEquations equations(exposed, events, c);
      for (int y = 0; y < kSensor.height_px; ++y)
        for (int x = 0; x < kSensor.width_px; ++x)
          // Logarithms are floats: only a value on the edge between two levels may differ.
          ASSERT_NEAR(gray(x, y), gray_of(equations.latent(x, y, 1s)), 1) << c << ' ' << bits;
    }
}

TYPED_TEST(DoubleIntegralTest, HandWorkedPixel) {
  // Half the exposure at L, half at L exp(0.5): B = 0.4 = L (1 + 1.6487)/2, L = 0.3020.
  // At its end L exp(0.5) = 0.4980; an OFF event later L again.
  TypeParam method(this->fixed(0.5), kSensor);
  method.process(std::vector<core::Event>{{150ms, 3, 4, true}, {250ms, 3, 4, false}});
  method.add_frame(test::frame(kSensor, 100ms, 200ms, 8, 102));
  EXPECT_EQ(this->picture_of(method, 250ms)(3, 4), gray_of(0.3020));
  EXPECT_EQ(this->picture_of(method, 250ms)(0, 0), gray_of(0.4));
  method.process(std::vector<core::Event>{{260ms, 3, 4, true}});
  EXPECT_EQ(this->picture_of(method, 260ms)(3, 4), gray_of(0.4980));
}

TYPED_TEST(DoubleIntegralTest, EventsBeforeTheExposureChangeNothingAndThoseAtItsEndComeAfter) {
  TypeParam method(this->fixed(0.5), kSensor);
  method.process(std::vector<core::Event>{{99999us, 3, 4, true}, {200ms, 5, 6, true}});
  method.add_frame(test::frame(kSensor, 100ms, 200ms, 8, 102));
  EXPECT_EQ(this->picture_of(method, 200ms)(3, 4), 102);
  EXPECT_EQ(this->picture_of(method, 200ms)(5, 6), gray_of(0.4 * std::exp(0.5)));
}

TYPED_TEST(DoubleIntegralTest, BeforeTheFirstFrameAMiddleGreyFollowsTheEvents) {
  TypeParam method(this->fixed(0.2), kSensor);
  method.process(
      std::vector<core::Event>{{1ms, 3, 4, true}, {2ms, 3, 4, true}, {2ms, 5, 6, false}});
  const Gray gray = this->picture_of(method, 2ms);
  EXPECT_EQ(gray(0, 0), 128);
  EXPECT_EQ(gray(3, 4), gray_of(0.5 * std::exp(0.4)));
  EXPECT_EQ(gray(5, 6), gray_of(0.5 * std::exp(-0.2)));
}

TYPED_TEST(DoubleIntegralTest, ABlackPixelCanStillBrighten) {
  TypeParam method(this->fixed(1.0), kSensor);
  method.add_frame(test::frame(kSensor, 0s, 1ms, 8, 0));
  std::vector<core::Event> events;
  for (int i = 0; i < 5; ++i) events.push_back({2ms, 3, 4, true});
  method.process(events);
  EXPECT_EQ(this->picture_of(method, 2ms)(0, 0), 1);  // half a level
  EXPECT_EQ(this->picture_of(method, 2ms)(3, 4), gray_of(0.5 / 255 * std::exp(5)));
}

TYPED_TEST(DoubleIntegralTest, EachFrameStartsAnew) {
  TypeParam twice(this->fixed(0.3), kSensor), once(this->fixed(0.3), kSensor);
  const auto events = test::random_events(kSensor, 4000, 1s, /*seed=*/8);
  const auto last = test::random_frame(kSensor, 500ms, 900ms, 8, /*seed=*/4);
  for (const core::Event& e : events) {
    twice.process({&e, 1});
    if (e.t >= 600ms && e.t - 600ms < 300us)
      twice.add_frame(test::random_frame(kSensor, 200ms, 600ms, 10, /*seed=*/5));
  }
  once.process(events);
  twice.add_frame(last);
  once.add_frame(last);
  EXPECT_EQ(this->picture_of(twice, 1s), this->picture_of(once, 1s));
}

TYPED_TEST(DoubleIntegralTest, ShorterHistoryThanTheExposureCountsWhatIsThere) {
  DoubleIntegralConfig config = this->fixed(0.5);
  config.history_s = 0.1;
  TypeParam method(config, kSensor);
  method.process(
      std::vector<core::Event>{{100ms, 3, 4, true}, {950ms, 3, 4, true}, {1s, 0, 0, true}});
  method.add_frame(test::frame(kSensor, 0s, 1s, 8, 102));
  // One event at 0.95 of the exposure: mean 0.95 + 0.05 exp(0.5).
  const double latent = 0.4 / (0.95 + 0.05 * std::exp(0.5)) * std::exp(0.5);
  EXPECT_EQ(this->picture_of(method, 1s)(3, 4), gray_of(latent));
  EXPECT_EQ(method.dropped(), 0u);
}

TYPED_TEST(DoubleIntegralTest, ExposuresOutOfReachAreTakenWithoutEvents) {
  TypeParam method(this->fixed(0.5), kSensor);
  method.process(std::vector<core::Event>{{10h, 3, 4, true}});
  method.add_frame(test::frame(kSensor, core::Time(-1000000), 1s, 8, 102));
  EXPECT_EQ(this->picture_of(method, 10h)(0, 0), 102);
  method.add_frame(test::frame(kSensor, 100h, 101h, 8, 51));
  EXPECT_EQ(this->picture_of(method, 10h)(3, 4), 51);
}

TYPED_TEST(DoubleIntegralTest, AnEventOf32BitsAgoIsNotTakenForAFreshOne) {
  TypeParam method(this->fixed(0.5), kSensor);
  constexpr core::Time kWrap{std::int64_t{1} << 32};
  method.process(std::vector<core::Event>{{1s, 3, 4, true}, {kWrap + 1500ms, 0, 0, true}});
  method.add_frame(test::frame(kSensor, kWrap + 900ms, kWrap + 1600ms, 8, 102));
  EXPECT_EQ(this->picture_of(method, kWrap + 2s)(3, 4), 102);
}

TYPED_TEST(DoubleIntegralTest, ABrokenPixelStaysFinite) {
  DoubleIntegralConfig config;
  config.search_greatest_log = 2;
  TypeParam method(config, kSensor);
  std::vector<core::Event> events;
  for (int i = 0; i < 100000; ++i) events.push_back({core::Time(i), 3, 4, true});
  for (int i = 0; i < 50; ++i)
    events.push_back({100ms, static_cast<std::uint16_t>(i % 16), 7, i % 3 == 0});
  method.process(events);
  method.add_frame(test::frame(kSensor, 0s, 200ms, 8, 102));
  EXPECT_EQ(this->picture_of(method, 200ms)(0, 0), 102);
  EXPECT_GE(this->picture_of(method, 200ms)(3, 4), 102);  // its end is its brightest time
}

TYPED_TEST(DoubleIntegralTest, SearchFindsTheThresholdOfAMovingCheckerboard) {
  for (const double travel_px : {6.0, 12.0})
    for (const double c : {0.1, 0.2, 0.35}) {
      const test::MovingCheckerboard scene(travel_px, c);
      TypeParam method({}, scene.kSize);
      method.process(scene.events);
      method.add_frame(scene.frame);
      // A pixel's last change is smaller than c and has no event, so somewhat more than c is
      // sharpest: by half a threshold in the log of 0.8 / 0.15, which is 1.67.
      EXPECT_GT(method.contrast_log(), 0.95 * c) << travel_px;
      EXPECT_LT(method.contrast_log(), c / (1 - 0.5 * c / 1.67) * 1.15) << travel_px;
    }
}

TYPED_TEST(DoubleIntegralTest, TheLatentPictureIsNearerTheSceneThanTheBlurredFrame) {
  const test::MovingCheckerboard scene(8.0, 0.1);
  TypeParam method({}, scene.kSize);
  method.process(scene.events);
  method.add_frame(scene.frame);
  const Gray gray = this->picture_of(method, scene.kExposure);
  double error = 0, frame_error = 0;
  for (int y = 0; y < scene.kSize.height_px; ++y)
    for (int x = 0; x < scene.kSize.width_px; ++x) {
      error += std::abs(gray(x, y) / 255.0 - scene.end(x, y));
      frame_error += std::abs(scene.frame.gray(x, y) / 1023.0 - scene.end(x, y));
    }
  // Of fields of 12 pixels, 8 pixels of blur leave most pixels between two levels; what the
  // model leaves is half a threshold, 5 %, and its search.
  EXPECT_LT(error, 0.4 * frame_error);
}

TYPED_TEST(DoubleIntegralTest, KeepsItsContrastWhereTheSearchFindsNone) {
  DoubleIntegralConfig config;
  config.contrast_log = 0.17;
  TypeParam method(config, kSensor);
  method.process(std::vector<core::Event>{{1ms, 3, 4, true}});
  method.add_frame(test::frame(kSensor, 2ms, 3ms, 8, 102));
  EXPECT_EQ(method.contrast_log(), 0.17);
}

TYPED_TEST(DoubleIntegralTest, RefusesAConfigOutOfRange) {
  DoubleIntegralConfig config;
  config.history_s = 0;
  EXPECT_THROW(TypeParam(config, kSensor), std::invalid_argument);
  config = {};
  config.search_greatest_log = 0.01;  // below the least
  EXPECT_THROW(TypeParam(config, kSensor), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::esi
