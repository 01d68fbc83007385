#include "scenarios/emulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using core::Event;
using core::Image;
using core::Resolution;
using core::Time;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// Frames from memory.
class FrameList : public camera::FrameSource {
 public:
  FrameList(std::vector<Image<float>> frames, double rate_hz)
      : frames_(std::move(frames)), rate_hz_(rate_hz) {}

  bool next(Image<float>& intensity) override {
    if (next_ == frames_.size()) return false;
    intensity = frames_[next_++];
    return true;
  }
  double rate_hz() const override { return rate_hz_; }
  int announced_frames() const override {
    return announced.value_or(static_cast<int>(frames_.size()));
  }
  std::uint64_t bad_values() const override { return bad; }

  std::optional<int> announced;
  std::uint64_t bad = 0;

 private:
  std::vector<Image<float>> frames_;
  double rate_hz_;
  std::size_t next_ = 0;
};

struct Result {
  std::vector<Event> events;
  Emulation emulation;
};

Result run(camera::FrameSource& frames, const EmulateOptions& options) {
  Result result;
  result.emulation = emulate(frames, options, [&](auto events) {
    result.events.insert(result.events.end(), events.begin(), events.end());
  });
  return result;
}

Result run(std::vector<Image<float>> frames, double rate_hz, const EmulateOptions& options) {
  FrameList list(std::move(frames), rate_hz);
  return run(list, options);
}

EmulateOptions preset(sim::SensorPreset name) {
  EmulateOptions options;
  options.sensor.preset = name;
  return options;
}

/// Thresholds of 0.2 exactly, no low pass, no noise.
EmulateOptions perfect() {
  EmulateOptions options = preset(sim::SensorPreset::custom);
  options.sensor.pixel = sim::preset_pixel(sim::SensorPreset::clean, 5.0);
  options.sensor.pixel.threshold_on_sigma_log = 0;
  options.sensor.pixel.threshold_off_sigma_log = 0;
  return options;
}

/// One pixel, given by 8-bit codes.
std::vector<Image<float>> pixel_frames(const std::vector<int>& codes) {
  std::vector<Image<float>> frames;
  for (const int code : codes)
    frames.emplace_back(Resolution{1, 1}, static_cast<float>(code) / 255.0f);
  return frames;
}

constexpr Resolution kSize{64, 16};
constexpr double kRateHz = 1000;
constexpr int kBarFront = 12, kBarBack = 4;  // first column right of the bar, first of the bar

/// A bright bar on dark ground that goes right by a pixel a frame.
std::vector<Image<float>> moving_bar(int frames) {
  std::vector<Image<float>> list;
  for (int k = 0; k < frames; ++k) {
    Image<float> frame(kSize, 0.2f);
    for (int y = 0; y < kSize.height_px; ++y)
      for (int x = kBarBack + k; x < kBarFront + k; ++x) frame(x, y) = 0.8f;
    list.push_back(frame);
  }
  return list;
}

TEST(EmulateTest, gives_the_events_that_a_known_log_ratio_asks_for) {
  // ln(150/50) = 1.0986: 5 steps of 0.2 up, to ln 50 + 1.0; from there to ln 40 are
  // 1.2231, 6 steps down. All codes lie above 20, where the pixel is logarithmic.
  const Result result = run(pixel_frames({50, 50, 150, 40}), 100, perfect());
  ASSERT_EQ(result.events.size(), 11u);
  const double up_log = std::log(150.0 / 50), down_log = std::log(150.0 / 40);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(result.events[i].on);
    // Linear in log intensity from 10 ms to 20 ms; 1 us is the resolution of time.
    EXPECT_NEAR(static_cast<double>(result.events[i].t.count()), 1e4 + 1e4 * 0.2 * (i + 1) / up_log,
                1.01);
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_FALSE(result.events[5 + i].on);
    const double below_peak_log = up_log - 1.0 + 0.2 * (i + 1);
    EXPECT_NEAR(static_cast<double>(result.events[5 + i].t.count()),
                2e4 + 1e4 * below_peak_log / down_log, 1.01);
  }
}

TEST(EmulateTest, settles_on_the_first_frame) {
  EXPECT_THAT(run(pixel_frames({200, 200, 200}), 100, perfect()).events, IsEmpty());
}

TEST(EmulateTest, gives_on_events_before_a_moving_bar_and_off_events_behind_it) {
  constexpr int kFrames = 40;
  const Result result = run(moving_bar(kFrames), kRateHz, preset(sim::SensorPreset::clean));
  std::map<std::pair<int, int>, int> on, off;
  for (const Event& event : result.events) {
    // Frame k is at k ms: what changed from k-1 to k fires in (k-1, k] ms. The readout
    // takes 1/12 us an event, 7 events a pixel and 32 pixels at once: below 20 us.
    const int edge_column = event.x - (event.on ? kBarFront : kBarBack);
    EXPECT_GT(event.t, Time(1000 * edge_column));
    EXPECT_LE(event.t, Time(1000 * (edge_column + 1) + 20));
    ++(event.on ? on : off)[{event.x, event.y}];
  }
  // Every pixel that an edge passed and no other; it was dark, bright and dark again.
  EXPECT_EQ(on.size(), static_cast<std::size_t>((kFrames - 1) * kSize.height_px));
  EXPECT_EQ(off.size(), on.size());
  // ln 4 = 1.386 over thresholds of 0.2 with a deviation of 0.02: 6.9, and from 5 to 9
  // within 4 deviations either way.
  for (const auto& [pixel, count] : on)
    EXPECT_THAT(count, testing::AllOf(testing::Ge(4), testing::Le(11)));
}

TEST(EmulateTest, hands_over_the_events_of_each_frame_in_order_and_counts_them) {
  FrameList frames(moving_bar(20), kRateHz);
  std::uint64_t on = 0, off = 0;
  std::vector<double> progress_s;
  Time last{};
  EmulateOptions options = preset(sim::SensorPreset::dim);
  options.on_progress = [&](double done_s, double end_s) {
    progress_s.push_back(done_s);
    EXPECT_DOUBLE_EQ(end_s, 0.019);
  };
  const Emulation emulation = emulate(frames, options, [&](auto events) {
    for (const Event& event : events) {
      EXPECT_GE(event.t, last);
      last = event.t;
      EXPECT_LE(event.t, Time(1000 * static_cast<int>(progress_s.size())));
      ++(event.on ? on : off);
    }
  });
  EXPECT_EQ(progress_s.size(), 20u);
  EXPECT_GT(on, 0u);
  EXPECT_EQ(emulation.events_on, on);
  EXPECT_EQ(emulation.events_off, off);
  EXPECT_EQ(emulation.frames, 20);
  EXPECT_EQ(emulation.size, kSize);
  EXPECT_DOUBLE_EQ(emulation.duration_s, 0.019);
  EXPECT_DOUBLE_EQ(emulation.event_rate_hz, static_cast<double>(on + off) / 0.019);
  EXPECT_EQ(emulation.events_lost, 0u);
  EXPECT_EQ(warning(emulation), "");
}

TEST(EmulateTest, gives_the_same_events_for_the_same_seed_alone) {
  EmulateOptions options = preset(sim::SensorPreset::dim);
  options.seed = 7;
  const auto first = run(moving_bar(20), kRateHz, options).events;
  EXPECT_TRUE(run(moving_bar(20), kRateHz, options).events == first);
  options.seed = 8;
  EXPECT_FALSE(run(moving_bar(20), kRateHz, options).events == first);
}

TEST(EmulateTest, asks_for_the_illuminance_only_where_the_preset_does) {
  EmulateOptions dim = preset(sim::SensorPreset::dim);
  const auto first = run(moving_bar(20), kRateHz, dim).events;
  dim.illuminance_lux = 300;
  EXPECT_TRUE(run(moving_bar(20), kRateHz, dim).events == first);
  EmulateOptions by_light = preset(sim::SensorPreset::by_illuminance);
  EXPECT_TRUE(run(moving_bar(20), kRateHz, by_light).events == first);  // dim is 5 lux
  by_light.illuminance_lux = 300;
  EXPECT_FALSE(run(moving_bar(20), kRateHz, by_light).events == first);
}

TEST(EmulateTest, counts_what_the_readout_loses) {
  EmulateOptions options = preset(sim::SensorPreset::clean);
  const auto all = run(moving_bar(20), kRateHz, options).emulation;
  options.sensor.readout.max_event_rate_hz = 1e5;
  options.sensor.readout.queue_capacity_events = 10;
  const auto some = run(moving_bar(20), kRateHz, options).emulation;
  EXPECT_GT(some.events_lost, 0u);
  const std::uint64_t all_events = all.events_on + all.events_off;
  const std::uint64_t accounted = some.events_on + some.events_off + some.events_lost;
  EXPECT_EQ(accounted, all_events);
  // When one is lost 10 wait, and the last of them waits for the others' 10 us each.
  EXPECT_GE(some.max_delay, Time(90));
}

TEST(EmulateTest, hands_over_what_waits_in_the_readout_after_the_last_frame) {
  EmulateOptions options = perfect();
  options.sensor.readout.max_event_rate_hz = 1e3;
  // 5 steps of 0.2 up (as above) within 100 us, then read out 1 ms apart.
  const Result result = run(pixel_frames({50, 150}), 1e4, options);
  ASSERT_EQ(result.events.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(result.events[i].t, result.events[0].t + Time(1000 * i));
  EXPECT_LT(result.events[0].t, Time(100));
  EXPECT_EQ(result.emulation.events_on, 5u);
  EXPECT_DOUBLE_EQ(result.emulation.duration_s, 1e-4);
  // The last crosses 4 of 5.49 steps' time (100 us) after the first; 1 us of rounding each.
  EXPECT_NEAR(static_cast<double>(result.emulation.max_delay.count()), 4000 - 4 * 100 / 5.49, 2);
}

TEST(EmulateTest, needs_two_frames) {
  EXPECT_THAT([] { run(pixel_frames({}), 100, perfect()); },
              ThrowsMessage<std::invalid_argument>("0 frames could be read, needed at least 2"));
  EXPECT_THAT([] { run(pixel_frames({50}), 100, perfect()); },
              ThrowsMessage<std::invalid_argument>("1 frames could be read, needed at least 2"));
}

TEST(EmulateTest, warns_of_what_was_wrong_with_the_frames) {
  FrameList frames(pixel_frames({50, 60, 70}), 100);
  frames.bad = 12;
  frames.announced = 40;
  const Emulation emulation = run(frames, perfect()).emulation;
  EXPECT_EQ(warning(emulation),
            "12 pixels of the frames were negative (taken as 0), NaN, infinite or beyond 1e20 "
            "(taken as the pixel's last value); only 3 of 40 frames could be decoded");
}

TEST(EmulateTest, holds_a_pixel_whose_frame_has_no_number) {
  auto frames = pixel_frames({50, 60, 50, 50});
  frames[1](0, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(run(frames, 100, perfect()).events, IsEmpty());
}

TEST(EmulateTest, writes_its_summary_as_json) {
  EmulateOptions options = preset(sim::SensorPreset::clean);
  options.sensor.readout.max_event_rate_hz = 1e6;  // slow enough that events wait
  const Emulation emulation = run(moving_bar(20), kRateHz, options).emulation;
  const auto json = nlohmann::json::parse(to_json(emulation));
  EXPECT_EQ(json["frames"], 20);
  EXPECT_EQ(json["width_px"], 64);
  EXPECT_EQ(json["fps"], 1000);
  EXPECT_EQ(json["events"], emulation.events_on + emulation.events_off);
  EXPECT_EQ(json["events_lost"], 0);
  EXPECT_EQ(json["bad_values"], 0);
  EXPECT_GT(emulation.max_delay, Time(0));
  EXPECT_EQ(json["max_delay_us"], emulation.max_delay.count());
  EXPECT_THAT(to_table(emulation),
              HasSubstr(std::to_string(emulation.max_delay.count()) + " us at most"));
}

/// A grating that drifts, as 8-bit codes.
cv::Mat grating(int frame) {
  cv::Mat picture(48, 64, CV_8U);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture.at<uchar>(y, x) = cv::saturate_cast<uchar>(
          128 + 110 * std::sin(2 * std::numbers::pi * (x + 0.3 * y - 0.5 * frame) / 16));
  return picture;
}

std::vector<Event> events_of(const std::string& extension, int type, double white) {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  const test::ScratchFolder folder;
  for (int i = 0; i < 24; ++i) {
    cv::Mat picture;
    grating(i).convertTo(picture, type, white / 255);
    EXPECT_TRUE(cv::imwrite((folder / (std::to_string(i) + extension)).string(), picture));
  }
  const auto frames = camera::open_frames(folder.path(), {.rate_hz = 500.0});
  return run(*frames, preset(sim::SensorPreset::clean)).events;
}

/// How often each pixel fired, ON counted 1 and OFF -1 apart.
std::map<std::tuple<int, int, bool>, int> counts(const std::vector<Event>& events) {
  std::map<std::tuple<int, int, bool>, int> result;
  for (const Event& event : events) ++result[{event.x, event.y, event.on}];
  return result;
}

TEST(EmulateTest, gives_nearly_the_same_events_from_8_bit_16_bit_and_float_pictures) {
  const std::vector<Event> from_8_bit = events_of(".png", CV_8U, 255);
  ASSERT_GT(from_8_bit.size(), 10000u);
  for (const auto& other : {events_of(".png", CV_16U, 65535), events_of(".exr", CV_32F, 1)}) {
    // The intensities differ by a rounding of a float (6e-8), log intensities by about
    // 5e-7 of a threshold's 0.2: of 10^5 events hardly one comes or goes.
    auto apart = counts(from_8_bit);
    for (const auto& [pixel, count] : counts(other)) apart[pixel] -= count;
    int differences = 0;
    for (const auto& [pixel, count] : apart) differences += std::abs(count);
    EXPECT_LE(differences, 2);
  }
}

}  // namespace
}  // namespace nightjar::scenarios
