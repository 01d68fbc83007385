#include "sim/aps.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// Grey level (0..255) of a mean luminance held for `exposure_s`.
double code(const ApsConfig& config, double lux, double exposure_s) {
  const double electrons = lux * exposure_s * config.electrons_per_lux_s;
  const double black = 4 * config.black_level;  // in codes of 10 bits
  return (black + (1023 - black) * std::min(1.0, electrons / config.full_well_e)) / 4;
}

struct Statistics {
  double mean = 0, deviation = 0;
};

Statistics statistics(const core::Image<std::uint16_t>& gray) {  // of 8 bits
  double sum = 0, squares = 0;
  for (const std::uint16_t g : gray.pixels()) {
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
  EXPECT_EQ(sensor.bad_radiance(), 3u * 11);  // 11 pictures
}

TEST(ApsSensor, good_radiance_is_not_counted) {
  ApsSensor sensor({}, kSize, 5, 8);
  frames(sensor, 0.0, Time(100'000), Time(10'000));
  EXPECT_EQ(sensor.bad_radiance(), 0u);
}

TEST(ApsSensor, eight_bits_are_the_upper_ones_of_ten) {
  ApsConfig ten;
  ten.bits = ApsBits::ten;
  for (const double lux : {0.0, 3.0, 1000.0}) {
    ApsSensor sensor_8({}, kSize, 5, 10), sensor_10(ten, kSize, 5, 10);
    const auto frame_8 = frames(sensor_8, lux, Time(500'000), Time(10'000)).at(0);
    const auto frame_10 = frames(sensor_10, lux, Time(500'000), Time(10'000)).at(0);
    EXPECT_EQ(frame_8.bits, 8);
    EXPECT_EQ(frame_10.bits, 10);
    for (std::size_t p = 0; p < frame_8.gray.pixels().size(); ++p)
      EXPECT_EQ(frame_8.gray.pixels()[p], frame_10.gray.pixels()[p] / 4);
    if (lux == 1000.0) {
      EXPECT_EQ(std::ranges::max(frame_10.gray.pixels()), 1023);
    }
  }
}

TEST(ApsSensor, switching_an_effect_off_leaves_the_draws_of_all_others) {
  // All pixels of two frames in electrons; a grey level of ten bits stands for 5 of them.
  const auto electrons = [](double read_noise_e, double offset_fpn_e, double gain_fpn) {
    ApsConfig config;
    config.bits = ApsBits::ten;
    config.full_well_e = 5 * (1023 - 64);
    config.electrons_per_lux_s = 1000;
    config.read_noise_e = read_noise_e;
    config.offset_fpn_e = offset_fpn_e;
    config.gain_fpn = gain_fpn;
    ApsSensor sensor(config, kSize, 5, 12);
    std::vector<double> all;
    for (const auto& frame : frames(sensor, 4, Time(1'000'000), Time(50'000)))
      for (const std::uint16_t gray : frame.gray.pixels()) all.push_back(5.0 * (gray - 64));
    return all;
  };
  constexpr double kRead = 100, kOffset = 200, kGain = 0.1, kPhoto = 4 * 0.5 * 1000;
  const auto all = electrons(kRead, kOffset, kGain);
  const auto without_read = electrons(0, kOffset, kGain);
  const auto without_offset = electrons(kRead, 0, kGain);
  const auto without_gain = electrons(kRead, kOffset, 0);
  const auto shot = electrons(0, 0, 0), read = electrons(kRead, 0, 0);
  const auto offset = electrons(0, kOffset, 0), gain = electrons(0, 0, kGain);
  ASSERT_EQ(all.size(), 2u * kSize.pixels());
  // Shot and read noise are one draw n: n sqrt(shot^2 + read^2). A pixel's gain moves its
  // shot noise, too: by 4 deviations of 10 % in sqrt(2000), 4 deviations of n.
  const double kMixed = 4 * std::sqrt(kPhoto) * (1 - std::sqrt(1 - 4 * kGain));
  const double kRounding = 4 * 2.5;  // four numbers, each to 5 electrons
  for (std::size_t p = 0; p < all.size(); ++p) {
    EXPECT_NEAR(all[p] - without_offset[p], offset[p] - shot[p], kRounding);
    EXPECT_NEAR(all[p] - without_gain[p], gain[p] - shot[p], kRounding + kMixed);
    EXPECT_NEAR(all[p] - without_read[p], read[p] - shot[p], kRounding + kMixed);
    EXPECT_NEAR((read[p] - kPhoto) / std::hypot(kRead, std::sqrt(kPhoto)),
                (shot[p] - kPhoto) / std::sqrt(kPhoto), 2.5 / 109 + 2.5 / 44 + 1e-3);
  }
  // And no draw repeats another's: correlations of one frame's pixels, 5 deviations.
  double offset_gain = 0, offset_shot = 0, gain_shot = 0;
  const std::size_t n = all.size() / 2;
  for (std::size_t p = 0; p < n; ++p) {
    const double o = (offset[p] - shot[p]) / kOffset, g = (gain[p] - shot[p]) / (kGain * kPhoto);
    const double s = (shot[p] - kPhoto) / std::sqrt(kPhoto);
    offset_gain += o * g;
    offset_shot += o * s;
    gain_shot += g * s;
  }
  for (const double sum : {offset_gain, offset_shot, gain_shot})
    EXPECT_NEAR(sum / static_cast<double>(n), 0, 5 / std::sqrt(n));
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
