#include "sim/aps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nightjar::sim {
namespace {

using core::Time;

constexpr core::Resolution kSize{64, 48};

ApsConfig noiseless() {
  ApsConfig config;
  config.read_noise_e = config.offset_fpn_e = config.gain_fpn = 0;
  return config;
}

/// Code (0..255) of a mean luminance held for `exposure_s`.
double code(const ApsConfig& config, double lux, double exposure_s) {
  const double electrons = lux * exposure_s * config.electrons_per_lux_s;
  const double black = 4 * config.black_level;  // in codes of 10 bits
  return (black + (1023 - black) * std::min(1.0, electrons / config.full_well_e)) / 4;
}

struct Statistics {
  double mean = 0, deviation = 0;
};

Statistics statistics(const core::Image<std::uint8_t>& gray) {
  double sum = 0, squares = 0;
  for (const std::uint8_t g : gray.pixels()) {
    sum += g + 0.375;  // a code of 8 bits stands for four of 10: 0, 1/4, 1/2, 3/4
    squares += (g + 0.375) * (g + 0.375);
  }
  const double n = gray.size().pixels();
  return {sum / n, std::sqrt(squares / n - sum * sum / n / n)};
}

/// Frames of a still picture over `end`, in steps of `dt`.
std::vector<core::ApsFrame> frames(ApsSensor& sensor, double lux, Time end, Time dt) {
  std::vector<core::ApsFrame> all;
  const core::Image<float> image(kSize, static_cast<float>(lux));
  for (Time t{}; t <= end; t += dt)
    if (auto frame = sensor.add(t, image)) all.push_back(std::move(*frame));
  return all;
}

TEST(ApsExposure, meets_the_paper_and_follows_the_light) {
  const ApsConfig config;
  EXPECT_EQ(aps_exposure(config, 2), Time(500'000));
  EXPECT_EQ(aps_exposure(config, 10), Time(500'000));
  EXPECT_EQ(aps_exposure(config, 1000), Time(5'000));
  EXPECT_EQ(aps_exposure({.exposure_ms = 12.5}, 1000), Time(12'500));
}

TEST(ApsSensor, two_frames_a_second_in_the_dark_twenty_five_in_the_light) {
  ApsSensor dark({}, kSize, 5, 1);
  const auto slow = frames(dark, 1, Time(2'000'000), Time(7'000));
  ASSERT_EQ(slow.size(), 3u);  // the fourth ends with the last step, which is before 2 s
  EXPECT_EQ(slow[1].exposure_begin, Time(500'000));
  EXPECT_EQ(slow[1].exposure_end, Time(1'000'000));

  ApsSensor bright({}, kSize, 1000, 1);
  const auto fast = frames(bright, 200, Time(1'000'000), Time(3'000));
  ASSERT_EQ(fast.size(), 25u);
  EXPECT_EQ(fast[3].exposure_begin, Time(120'000));
  EXPECT_EQ(fast[3].exposure_end, Time(125'000));
}

TEST(ApsSensor, the_mean_is_the_exposure) {
  for (const double lux : {0.0, 0.5, 3.0}) {
    ApsSensor sensor(noiseless(), kSize, 5, 2);
    const auto all = frames(sensor, lux, Time(600'000), Time(9'000));
    ASSERT_EQ(all.size(), 1u);
    // Shot noise of 5 standard errors, in codes, and 1/8 for the ten-bit rounding.
    const double electrons = lux * 0.5 * 4000;
    const double sigma = 0.25 * (1023 - 64) / 25000 * std::sqrt(electrons);
    EXPECT_NEAR(statistics(all[0].gray).mean, code(noiseless(), lux, 0.5),
                5 * sigma / std::sqrt(kSize.pixels()) + 0.5);
  }
}

TEST(ApsSensor, motion_blurs_by_the_time_spent_on_each_pixel) {
  // An edge that moves 40 px in the exposure: pixel x is lit for the rest of it.
  ApsConfig config = noiseless();
  config.exposure_ms = 100;
  config.electrons_per_lux_s = 20000;
  ApsSensor sensor(config, kSize, 5, 3);
  std::optional<core::ApsFrame> frame;
  for (int t_ms = 0; t_ms <= 100; ++t_ms) {
    core::Image<float> image(kSize);
    for (int y = 0; y < kSize.height_px; ++y)
      for (int x = 0; x < kSize.width_px; ++x) image(x, y) = x < 10 + 0.4 * t_ms ? 5.0f : 0.0f;
    auto got = sensor.add(Time(t_ms * 1000), image);
    if (got) frame = std::move(got);
  }
  ASSERT_TRUE(frame);
  for (int x = 0; x < kSize.width_px; ++x) {
    double mean = 0;
    for (int y = 0; y < kSize.height_px; ++y) mean += frame->gray(x, y) + 0.375;
    const double lit_s = std::clamp(0.1 - (x - 10) / 400.0, 0.0, 0.1);
    // A step of 1 ms is 1.3 codes (its edge is anywhere in it, and x = edge is unlit);
    // 5 standard errors of shot noise over 48 rows are 0.7.
    EXPECT_NEAR(mean / kSize.height_px, code(config, 5, lit_s), 4.0) << x;
  }
}

TEST(ApsSensor, a_step_over_an_exposure_counts_only_what_falls_into_it) {
  // Light that rises linearly from 0 at 0 to 300 lux at 30 ms; exposures of 10 ms.
  ApsConfig config = noiseless();
  config.exposure_ms = 10;
  config.interval_ms = 20;
  config.electrons_per_lux_s = 5000;
  ApsSensor sensor(config, kSize, 300, 4);
  std::vector<double> means;
  for (const int t_ms : {0, 7, 16, 27, 31}) {
    const core::Image<float> image(kSize, static_cast<float>(10 * t_ms));
    if (const auto frame = sensor.add(Time(t_ms * 1000), image))
      means.push_back(statistics(frame->gray).mean);
  }
  ASSERT_EQ(means.size(), 2u);
  EXPECT_NEAR(means[0], code(config, 50, 0.01), 0.6);  // as in the_mean_is_the_exposure
  EXPECT_NEAR(means[1], code(config, 250, 0.01), 0.6);
}

TEST(ApsSensor, exposures_back_to_back_lose_no_light) {
  // The same rise of light; the step from 7 to 16 ms belongs to two exposures.
  ApsConfig config = noiseless();
  config.exposure_ms = config.interval_ms = 10;
  config.electrons_per_lux_s = 5000;
  ApsSensor sensor(config, kSize, 300, 9);
  std::vector<double> means;
  for (const int t_ms : {0, 7, 16, 26}) {
    const core::Image<float> image(kSize, static_cast<float>(10 * t_ms));
    if (const auto frame = sensor.add(Time(t_ms * 1000), image))
      means.push_back(statistics(frame->gray).mean);
  }
  ASSERT_EQ(means.size(), 2u);
  EXPECT_NEAR(means[0], code(config, 50, 0.01), 0.6);
  EXPECT_NEAR(means[1], code(config, 150, 0.01), 0.6);
}

TEST(ApsSensor, noise_is_what_photons_and_readout_make) {
  ApsConfig config = noiseless();
  config.read_noise_e = 200;
  ApsSensor sensor(config, kSize, 10, 5);
  const auto all = frames(sensor, 4, Time(500'000), Time(10'000));
  ASSERT_EQ(all.size(), 1u);
  const double codes_per_e = 0.25 * (1023 - 64) / 25000;
  const double expected = std::hypot(codes_per_e * std::sqrt(4 * 0.5 * 4000 + 200 * 200),
                                     1 / std::sqrt(12.0));  // and an 8-bit code's width
  EXPECT_NEAR(statistics(all[0].gray).deviation, expected,
              5 * expected / std::sqrt(2.0 * kSize.pixels()));
}

TEST(ApsSensor, fixed_pattern_is_the_same_in_every_frame_and_seed_by_seed) {
  ApsConfig config = noiseless();
  config.offset_fpn_e = 2000;
  ApsSensor sensor(config, kSize, 5, 6), other(config, kSize, 5, 7);
  const auto all = frames(sensor, 2, Time(1'000'000), Time(10'000));
  const auto others = frames(other, 2, Time(500'000), Time(10'000));
  ASSERT_EQ(all.size(), 2u);
  int differ = 0, others_differ = 0;
  for (std::size_t p = 0; p < all[0].gray.pixels().size(); ++p) {
    const int gray = all[0].gray.pixels()[p];
    differ += std::abs(gray - all[1].gray.pixels()[p]) > 5;  // shot noise: 0.6 codes
    others_differ += std::abs(gray - others[0].gray.pixels()[p]) > 5;
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(others_differ, kSize.pixels() / 2);
}

TEST(ApsSensor, saturates_and_bears_unusable_radiance) {
  ApsSensor sensor({}, kSize, 5, 8);
  core::Image<float> image(kSize, 1000.0f);
  image(0, 0) = std::numeric_limits<float>::quiet_NaN();
  image(1, 0) = -50.0f;
  image(2, 0) = std::numeric_limits<float>::infinity();
  std::optional<core::ApsFrame> frame;
  for (int t_ms = 0; t_ms <= 500; t_ms += 50)
    if (auto got = sensor.add(Time(t_ms * 1000), image)) frame = std::move(got);
  ASSERT_TRUE(frame);
  EXPECT_LT(frame->gray(0, 0), 30);
  EXPECT_LT(frame->gray(1, 0), 30);
  EXPECT_EQ(frame->gray(2, 0), 255);
  EXPECT_EQ(frame->gray(3, 3), 255);
}

TEST(ApsSensor, wrong_input_is_refused) {
  EXPECT_THROW(ApsSensor({}, {0, 4}, 5, 1), std::invalid_argument);
  EXPECT_THROW(ApsSensor({}, kSize, 0, 1), std::invalid_argument);
  EXPECT_THROW(ApsSensor({.full_well_e = -1}, kSize, 5, 1), std::invalid_argument);
  ApsSensor sensor({}, kSize, 5, 1);
  sensor.add(Time(1'000), core::Image<float>(kSize));
  EXPECT_THROW(sensor.add(Time(1'000), core::Image<float>(kSize)), std::invalid_argument);
  EXPECT_THROW(sensor.add(Time(2'000), core::Image<float>({3, 3})), std::invalid_argument);
  EXPECT_THROW(sensor.add(Time(700'000), core::Image<float>(kSize)), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::sim
