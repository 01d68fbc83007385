#include "esi/frame_blend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "tests/support/frames.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;
using Gray = core::Image<std::uint8_t>;
using Cells = std::vector<MemoryCell>;

constexpr double kLevelsPerSigma = 45;
constexpr core::Time kOpened = 60ms, kNow = 100ms;

Cells cells(core::Resolution size, MemoryCell cell = {}) {
  return Cells(static_cast<std::size_t>(size.pixels()), cell);
}

/// A pixel whose last event, of many, was at `t`.
MemoryCell pixel_with_event(core::Time t) {
  MemoryCell cell;
  cell.sum[3] = 0.8f;
  cell.sum[6] = 1.0f;
  cell.t_us = static_cast<std::uint32_t>(t.count());
  return cell;
}

/// Left half black enough, right half twice as bright: 50 from a mean of 150.
core::ApsFrame two_halves(core::Resolution size) {
  core::ApsFrame frame = test::frame(size, kOpened, kOpened + 5ms, 8, 100);
  for (int y = 0; y < size.height_px; ++y)
    for (int x = size.width_px / 2; x < size.width_px; ++x) frame.gray(x, y) = 200;
  return frame;
}

Gray blended(const core::ApsFrame& frame, const Cells& cells, core::Time t, Gray gray) {
  FrameBlend blend(frame.gray.size(), kLevelsPerSigma);
  blend.take(frame);
  blend.blend(cells, t, gray);
  return gray;
}

/// The header in doubles.
class Description {
 public:
  Description(const core::ApsFrame& frame, const Cells& cells, core::Time t)
      : frame_(frame), cells_(cells), t_(t) {
    double sum = 0, squares = 0;
    for (const double value : frame.gray.pixels()) {
      sum += value;
      squares += value * value;
    }
    const auto count = static_cast<double>(frame.gray.pixels().size());
    mean_ = sum / count;
    unit_ = std::max(std::sqrt(std::max(squares / count - mean_ * mean_, 0.0)), 0.15 * mean_);
  }

  double level(int x, int y, double events) const {
    if (frame_.gray.pixels().size() == 1) return events;  // all alike
    double nearby = 0, busy = 0;
    for (int v = std::max(y - 8, 0); v <= std::min(y + 8, frame_.gray.height() - 1); ++v)
      for (int u = std::max(x - 8, 0); u <= std::min(x + 8, frame_.gray.width() - 1); ++u) {
        ++nearby;
        busy += is_busy(cell(u, v));
      }
    const double g = busy / nearby;
    const double weight = (1 - g * g) / (1 + g / 0.25 * (g / 0.25));
    double brightness = frame_.gray(x, y);
    if (is_busy(cell(x, y))) {
      const double left = std::max(1 - 15 * age_s(cell(x, y)), 0.0);
      brightness *= std::exp(0.15 * double{cell(x, y).sum[3]} * left);
    }
    const double shown = 127.5 + 0.75 * kLevelsPerSigma * (brightness - mean_) / unit_;
    return events + weight * (std::clamp(shown, 0.0, 255.0) - events);
  }

 private:
  const MemoryCell& cell(int x, int y) const {
    return cells_[static_cast<std::size_t>(y * frame_.gray.width() + x)];
  }
  double age_s(const MemoryCell& cell) const { return core::seconds(t_) - 1e-6 * cell.t_us; }
  bool is_busy(const MemoryCell& cell) const {
    return cell.sum[6] > 0 && core::Time(cell.t_us) >= frame_.exposure_begin;
  }

  const core::ApsFrame& frame_;
  const Cells& cells_;
  core::Time t_;
  double mean_ = 0, unit_ = 0;
};

void expect_as_described(core::Resolution size, std::uint64_t seed, std::uint32_t most_age_us) {
  core::Random random = core::random_stream(seed, "test.frame_blend");
  Cells all = cells(size);
  for (MemoryCell& cell : all) {
    cell.sum[3] = static_cast<float>(random() % 1600) / 100 - 8;
    cell.sum[6] = static_cast<float>(random() % 3);  // a third never had an event
    cell.t_us = static_cast<std::uint32_t>(kNow.count() - random() % most_age_us);
  }
  Gray gray(size);
  for (auto& level : gray.pixels()) level = static_cast<std::uint8_t>(random() % 256);
  core::ApsFrame frame{kOpened, kOpened + 5ms, 10, core::Image<std::uint16_t>(size)};
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x)
      frame.gray(x, y) = static_cast<std::uint16_t>(
          500 + 300 * std::sin(0.2 * x) * std::cos(0.1 * y) + static_cast<double>(random() % 100));
  const Gray found = blended(frame, all, kNow, gray);
  const Description description(frame, all, kNow);
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x)
      // Rounded to the nearest, and a float's rounding of 255 levels is below 1e-3.
      ASSERT_NEAR(found(x, y), description.level(x, y, gray(x, y)), 0.502) << x << ", " << y;
}

TEST(FrameBlend, is_as_described_in_doubles_at_any_size) {
  expect_as_described({1, 1}, /*seed=*/1, 80'000);
  expect_as_described({5, 23}, /*seed=*/2, 80'000);  // narrower than it reaches
  expect_as_described({31, 17}, /*seed=*/3, 100'000);
  expect_as_described({130, 61}, /*seed=*/4, 80'000);
  expect_as_described({130, 61}, /*seed=*/5, 41'000);  // nearly all of those with events busy
}

TEST(FrameBlend, shows_a_frame_without_events_since_in_deviations) {
  constexpr core::Resolution kSize{40, 6};
  const Gray gray = blended(two_halves(kSize), cells(kSize), kNow, Gray(kSize, 7));
  EXPECT_EQ(gray(0, 0), 94);    // 127.5 - 0.75 * 45
  EXPECT_EQ(gray(39, 5), 161);  // 127.5 + 0.75 * 45
}

TEST(FrameBlend, leaves_the_picture_where_every_pixel_has_had_an_event) {
  constexpr core::Resolution kSize{40, 6};
  const Gray gray(kSize, 7);
  EXPECT_EQ(blended(two_halves(kSize), cells(kSize, pixel_with_event(kOpened)), kNow, gray), gray);
}

TEST(FrameBlend, takes_no_notice_of_events_before_the_shutter_opened) {
  constexpr core::Resolution kSize{40, 6};
  const auto frame = two_halves(kSize);
  EXPECT_EQ(blended(frame, cells(kSize, pixel_with_event(kOpened - 1us)), kNow, Gray(kSize)),
            blended(frame, cells(kSize), kNow, Gray(kSize)));
}

TEST(FrameBlend, takes_the_time_of_the_start_for_no_event) {
  constexpr core::Resolution kSize{40, 6};
  MemoryCell untouched;
  untouched.t_us = static_cast<std::uint32_t>(core::Time(kOpened + 1ms).count());
  const auto frame = two_halves(kSize);
  EXPECT_EQ(blended(frame, cells(kSize, untouched), kNow, Gray(kSize)),
            blended(frame, cells(kSize), kNow, Gray(kSize)));
}

TEST(FrameBlend, shows_a_frame_of_hardly_any_contrast_as_faint) {
  constexpr core::Resolution kSize{40, 6};
  auto frame = two_halves(kSize);
  for (std::uint16_t& value : frame.gray.pixels())
    value = value == 100 ? std::uint16_t{99} : std::uint16_t{101};
  // 1 of 15, which is 0.15 of the mean, times 0.75 * 45: 2.25 levels.
  const Gray gray = blended(frame, cells(kSize), kNow, Gray(kSize, 7));
  EXPECT_EQ(gray(0, 0), 125);
  EXPECT_EQ(gray(39, 0), 130);
}

TEST(FrameBlend, leaves_out_frames_that_are_noise_or_all_alike) {
  constexpr core::Resolution kSize{40, 60};
  const Gray gray(kSize, 7);
  for (const int seed : {1, 2, 3})  // neighbours as far apart as any two
    EXPECT_EQ(blended(test::random_frame(kSize, kOpened, kOpened + 5ms, 8, seed), cells(kSize),
                      kNow, gray),
              gray);
  for (const std::uint16_t value : std::initializer_list<std::uint16_t>{0, 16, 255})
    EXPECT_EQ(
        blended(test::frame(kSize, kOpened, kOpened + 5ms, 8, value), cells(kSize), kNow, gray),
        gray);
}

TEST(FrameBlend, draws_the_line_where_noise_is_a_fifth) {
  // Stripes of 1 px, a up and a down, on two halves 200 apart: a variance of a^2 + 100^2, and
  // half the mean square from one pixel to the next is 2 a^2, but for the step in the middle.
  constexpr core::Resolution kSize{200, 1};
  const auto shown = [&](int a) {
    core::ApsFrame frame = test::frame(kSize, kOpened, kOpened + 5ms, 10, 300);
    for (int x = 0; x < 200; ++x)
      frame.gray(x, 0) = static_cast<std::uint16_t>(300 + (x < 100 ? 0 : 200) + (x % 2 ? a : -a));
    const Gray gray(kSize, 7);
    return blended(frame, cells(kSize), kNow, gray) != gray;
  };
  // 2 a^2 = 0.2 (a^2 + 100^2) at 33.3, at 33.1 with the step.
  EXPECT_TRUE(shown(33));
  EXPECT_FALSE(shown(34));
}

TEST(FrameBlend, shows_neither_frames_of_long_ago_nor_forgotten_ones) {
  constexpr core::Resolution kSize{40, 6};
  const Gray gray(kSize, 7);
  constexpr core::Time kMost{1u << 30};
  EXPECT_NE(blended(two_halves(kSize), cells(kSize), kOpened + kMost, gray), gray);
  EXPECT_EQ(blended(two_halves(kSize), cells(kSize), kOpened + kMost + 1us, gray), gray);
  FrameBlend blend(kSize, kLevelsPerSigma);
  blend.take(two_halves(kSize));
  blend.clear();
  Gray after = gray;
  blend.blend(cells(kSize), kNow, after);
  EXPECT_EQ(after, gray);
}

TEST(FrameBlend, shows_the_newest_frame_taken) {
  constexpr core::Resolution kSize{40, 6};
  FrameBlend blend(kSize, kLevelsPerSigma);
  Gray first(kSize), second(kSize);
  core::ApsFrame frame = two_halves(kSize);
  std::ranges::reverse(frame.gray.pixels());
  blend.take(frame);
  blend.blend(cells(kSize), kNow, first);
  blend.take(two_halves(kSize));
  blend.blend(cells(kSize), kNow, second);
  EXPECT_NE(first, second);
  EXPECT_EQ(second, blended(two_halves(kSize), cells(kSize), kNow, Gray(kSize)));
}

}  // namespace
}  // namespace nightjar::esi
