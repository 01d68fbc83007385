#include "esi/complementary_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/events.h"
#include "tests/support/frames.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;
using Gray = core::Image<std::uint8_t>;

constexpr core::Resolution kSensor{16, 12};

Gray picture_of(ComplementaryFilter& filter, core::Time t) {
  core::Picture picture;
  filter.render(t, picture);
  return picture.gray;
}

int gray_of(double log, double black, double white) {
  const double share = (std::exp(log) - 1 - black) / (white - black);
  return static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

/// The equations in doubles, all pixels brought up to every event, frame and picture.
class ByTheEquations {
 public:
  explicit ByTheEquations(const ComplementaryFilterConfig& config) : config_(config) {
    for (int i = 0; i < kSensor.pixels(); ++i)
      pixels_.push_back({0, 0, 2 * std::numbers::pi * config.high_pass_hz});
  }

  void advance(core::Time t) {
    for (Pixel& p : pixels_) {
      const double beta = std::exp(-p.omega * (core::seconds(t) - t_s_));
      p.log = beta * p.log + (1 - beta) * p.aps_log;
    }
    t_s_ = core::seconds(t);
  }

  void add(const core::Event& e) {
    advance(e.t);
    double& log = pixels_[static_cast<std::size_t>(e.y * kSensor.width_px + e.x)].log;
    if (!has_frame_) log *= std::exp(-config_.high_pass_per_event);
    log += e.on ? config_.contrast_on_log : -config_.contrast_off_log;
  }

  void add(const core::ApsFrame& frame) {
    advance(frame.exposure_end);
    has_frame_ = true;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const double brightness = frame.gray.pixels()[i] / ((1 << frame.bits) - 1.0);
      const double log = std::log(1 + brightness);
      const double dark = std::log(1 + config_.saturation_margin);
      const double bright = std::log(2 - config_.saturation_margin);
      double severity = 1;
      if (log < dark) severity = log / dark;
      if (log > bright) severity = (std::log(2) - log) / (std::log(2) - bright);
      const double least = config_.saturated_share;
      pixels_[i].aps_log = log;
      pixels_[i].omega =
          2 * std::numbers::pi * config_.cutoff_hz * (least + severity * (1 - least));
    }
  }

  Gray picture(core::Time t) {
    advance(t);
    Gray gray(kSensor);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      gray.pixels()[i] = static_cast<std::uint8_t>(
          has_frame_ ? gray_of(pixels_[i].log, config_.black, config_.white)
                     : gray_of(pixels_[i].log, config_.high_pass_black, config_.high_pass_white));
    return gray;
  }

 private:
  struct Pixel {
    double log, aps_log, omega;
  };
  ComplementaryFilterConfig config_;
  std::vector<Pixel> pixels_;
  double t_s_ = 0;
  bool has_frame_ = false;
};

void expect_near(const Gray& a, const Gray& b, const char* when) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i)
    // Sums are floats: only a value on the edge between two levels may differ.
    ASSERT_NEAR(a.pixels()[i], b.pixels()[i], 1) << when << ' ' << i;
}

TEST(ComplementaryFilter, AgreesWithTheEquationsWithAndWithoutFrames) {
  for (const double cutoff_hz : {0.0, 0.5, 100.0}) {
    ComplementaryFilterConfig config;
    config.cutoff_hz = cutoff_hz;
    config.contrast_off_log = 0.13;
    ComplementaryFilter filter(config, kSensor);
    ByTheEquations expected(config);
    const auto events = test::random_events(kSensor, 40000, 20s, /*seed=*/3);
    auto next = events.begin();
    const auto take_until = [&](core::Time t) {
      for (; next != events.end() && next->t <= t; ++next) {
        filter.process({&*next, 1});
        expected.add(*next);
      }
    };
    take_until(5s);
    expect_near(picture_of(filter, 5s), expected.picture(5s), "before frames");
    for (int i = 6; i < 20; ++i) {
      take_until(i * 1s);
      const auto frame =
          test::random_frame(kSensor, i * 1s - 100ms, i * 1s, i % 2 == 0 ? 8 : 10, /*seed=*/i);
      filter.add_frame(frame);
      expected.add(frame);
      take_until(i * 1s + 300ms);
      expect_near(picture_of(filter, i * 1s + 300ms), expected.picture(i * 1s + 300ms), "after");
    }
  }
}

TEST(ComplementaryFilter, HighPassAgreesWithTheEquations) {
  for (const double per_event : {0.0, 0.06, 1.0}) {
    ComplementaryFilterConfig config;
    config.use_frames = false;
    config.high_pass_per_event = per_event;
    config.high_pass_hz = 0.5;
    ComplementaryFilter filter(config, kSensor);
    ByTheEquations expected(config);
    const auto events = test::random_events(kSensor, 20000, 20s, /*seed=*/4);
    filter.process(events);
    filter.add_frame(test::random_frame(kSensor, 0s, 1s, 8, /*seed=*/1));
    for (const core::Event& e : events) expected.add(e);
    expect_near(picture_of(filter, 21s), expected.picture(21s), "high pass");
  }
}

TEST(ComplementaryFilter, HandWorkedHighPass) {
  // 0.1, then a second later 0.1 exp(-2 pi 0.06 - 0.06) + 0.1 = 0.1646.
  ComplementaryFilter filter({}, kSensor);
  filter.process(std::vector<core::Event>{{1s, 3, 4, true}});
  EXPECT_EQ(picture_of(filter, 1s)(3, 4), gray_of(0.1, -0.5, 1.5));
  filter.process(std::vector<core::Event>{{2s, 3, 4, true}});
  EXPECT_EQ(picture_of(filter, 2s)(3, 4), gray_of(0.1646, -0.5, 1.5));
  EXPECT_EQ(picture_of(filter, 2s)(5, 5), 64);  // brightness 0 of -0.5 to 1.5
}

TEST(ComplementaryFilter, HandWorkedFrameTakesOverFromItsEndOn) {
  // L_aps = log(1 + 102/255) = 0.3365; a second at 0.5 Hz: beta = exp(-pi) = 0.0432.
  ComplementaryFilter filter({}, kSensor);
  const auto frame = test::frame(kSensor, 900ms, 1s, 8, 102);
  filter.add_frame(frame);
  EXPECT_EQ(picture_of(filter, 500ms)(3, 4), gray_of(0, -0.1, 1.2)) << "not yet";
  EXPECT_EQ(picture_of(filter, 1s)(3, 4), gray_of(0, -0.1, 1.2));
  EXPECT_EQ(picture_of(filter, 2s)(3, 4), gray_of(0.3365 * (1 - 0.0432), -0.1, 1.2));
  filter.process(std::vector<core::Event>{{2s, 3, 4, false}});
  EXPECT_EQ(picture_of(filter, 2s)(3, 4), gray_of(0.3365 * (1 - 0.0432) - 0.1, -0.1, 1.2));
}

TEST(ComplementaryFilter, ASaturatedPixelFollowsTheFrameSlowly) {
  // White: a tenth of 0.5 Hz, so after a second exp(-0.1 pi) = 0.7304 is left to go.
  ComplementaryFilter filter({}, kSensor);
  filter.add_frame(test::frame(kSensor, 0s, 1us, 8, 255));
  EXPECT_EQ(picture_of(filter, 1s + 1us)(3, 4), gray_of(std::log(2) * (1 - 0.7304), -0.1, 1.2));
}

TEST(ComplementaryFilter, AnEventBeforeTheLastFramesEndCountsAsThen) {
  ComplementaryFilter late({}, kSensor), then({}, kSensor);
  for (ComplementaryFilter* filter : {&late, &then})
    filter->add_frame(test::frame(kSensor, 0s, 1s, 8, 102));
  late.process(std::vector<core::Event>{{800ms, 3, 4, true}, {900ms, 3, 4, true}});
  then.process(std::vector<core::Event>{{1s, 3, 4, true}, {1s, 3, 4, true}});
  EXPECT_EQ(picture_of(late, 1500ms), picture_of(then, 1500ms));
  EXPECT_NE(picture_of(late, 1500ms)(3, 4), picture_of(late, 1500ms)(5, 5));
}

TEST(ComplementaryFilter, AgesAreLimitedRightWhileAFrameIsAhead) {
  // Ages are limited at 20 min, when the frame's end at 25 min is still to come. A minute after
  // that end, at 0.0005 Hz: 1 - exp(-2 pi 0.03) = 0.1718 of L_aps = 0.3365.
  ComplementaryFilterConfig config;
  config.cutoff_hz = 0.0005;
  ComplementaryFilter filter(config, kSensor);
  filter.process(std::vector<core::Event>{{10min, 3, 4, true}});
  filter.add_frame(test::frame(kSensor, 10min, 25min, 8, 102));
  filter.process(std::vector<core::Event>{{20min, 3, 4, true}});
  EXPECT_EQ(picture_of(filter, 26min)(9, 9), gray_of(0.3365 * 0.1718, -0.1, 1.2));
}

TEST(ComplementaryFilter, HoursWithoutEventsLeaveTheFrameAlone) {
  ComplementaryFilter filter({}, kSensor);
  filter.process(std::vector<core::Event>{{1s, 3, 4, true}});
  filter.add_frame(test::frame(kSensor, 1s, 2s, 8, 102));
  filter.process(std::vector<core::Event>{{5h, 9, 9, false}});
  const Gray gray = picture_of(filter, 5h);
  EXPECT_EQ(gray(3, 4), gray_of(0.3365, -0.1, 1.2));
  EXPECT_EQ(gray(9, 9), gray_of(0.3365 - 0.1, -0.1, 1.2));
}

TEST(ComplementaryFilter, FiltersThePictureNotTheState) {
  ComplementaryFilterConfig config;
  config.filter = SpatialFilter::gaussian;
  config.filter_sigma = 1;
  ComplementaryFilter filtered(config, kSensor), plain({}, kSensor);
  const auto events = test::random_events(kSensor, 2000, 1s, /*seed=*/5);
  filtered.process(events);
  plain.process(events);
  Gray expected = picture_of(plain, 1s);
  PictureFilter(SpatialFilter::gaussian, 1).apply(expected);
  EXPECT_EQ(picture_of(filtered, 1s), expected);
  EXPECT_EQ(picture_of(filtered, 1s), expected);
}

TEST(ComplementaryFilter, LookingBetweenEventsChangesNothing) {
  ComplementaryFilter watched({}, kSensor), alone({}, kSensor);
  const auto events = test::random_events(kSensor, 2000, 1s, /*seed=*/6);
  for (const core::Event& e : events) {
    watched.process({&e, 1});
    picture_of(watched, e.t);
  }
  alone.process(events);
  EXPECT_EQ(picture_of(watched, 1s), picture_of(alone, 1s));
}

TEST(ComplementaryFilter, RefusesAConfigOutOfRange) {
  ComplementaryFilterConfig config;
  config.cutoff_hz = -1;
  EXPECT_THROW(ComplementaryFilter(config, kSensor), std::invalid_argument);
  config = {};
  config.white = config.black;
  EXPECT_THROW(ComplementaryFilter(config, kSensor), std::invalid_argument);
  config = {};
  config.high_pass_black = 2;
  EXPECT_THROW(ComplementaryFilter(config, kSensor), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::esi
