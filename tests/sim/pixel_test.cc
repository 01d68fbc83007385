#include "sim/pixel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "sim/pixel_kernel.h"
#include "sim/pixel_math.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::sim {
namespace {

/// Arrays for a kernel call, seeded with a plausible state.
struct Pixels {
  explicit Pixels(std::size_t count, std::uint64_t seed) {
    core::Random random = core::random_stream(seed, "kernel_test");
    for (auto& array : floats) array.resize(count);
    crossed.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      floats[0][i] = static_cast<float>(5 * core::uniform01(random));    // luminance
      floats[1][i] = static_cast<float>(255 * core::uniform01(random));  // intensity
      floats[2][i] = static_cast<float>(
          test::ScalarPixel::log_intensity(static_cast<double>(floats[1][i]), 20));
      floats[3][i] = static_cast<float>(core::uniform01(random) - 0.5);  // lag
      floats[4][i] = static_cast<float>(0.2 * core::uniform01(random) - 0.1);
      floats[5][i] = floats[6][i] = 0.2f;
      floats[7][i] = 0.02f;
    }
  }
  KernelBlock block(std::size_t from = 0) {
    const auto at = [&](std::size_t array) { return floats[array].data() + from; };
    return {at(0),
            at(1),
            at(2),
            at(3),
            at(4),
            at(5),
            at(6),
            at(7),
            at(8),
            at(9),
            at(10),
            at(11),
            crossed.data() + from};
  }
  std::array<std::vector<float>, 12> floats;
  std::vector<std::uint32_t> crossed;
};

PixelConfig quiet() {
  PixelConfig config = preset_pixel(SensorPreset::dim, 5);
  config.leak_rate_hz = config.shot_noise_rate_hz = config.hot_pixel_fraction = 0;
  return config;
}

KernelStep step_of(const PixelConfig& config, double dt_s) {
  KernelStep step = kernel_step(config, 5.0);
  set_step(step, config, dt_s);
  return step;
}

TEST(PixelMath, logarithm_is_good_to_single_precision) {
  for (double x = 1e-3; x < 1e6; x *= 1.0007) {
    const auto value = static_cast<float>(x);
    const double truth = std::log(static_cast<double>(value));
    // 2 ulp of a float, absolute near the zero at 1.
    EXPECT_NEAR(fast_log(value), truth, 2.4e-7 * std::max(1.0, std::abs(truth))) << x;
  }
}

TEST(PixelMath, one_minus_exp_keeps_its_relative_precision_down_to_nothing) {
  for (double a = 1e-9; a < 80; a *= 1.003) {
    const auto value = static_cast<float>(a);
    const double truth = -std::expm1(-static_cast<double>(value));
    EXPECT_NEAR(fast_one_minus_exp(value), truth, 2.4e-7 * truth) << a;  // 2 ulp
  }
  EXPECT_EQ(fast_one_minus_exp(0.0f), 0.0f);
}

TEST(PixelKernel, a_step_of_any_length_agrees_with_v2e_in_tiny_steps) {
  // v2e's Euler update with 20,000 substeps; its own error is k dt / 20,000 < 3e-4 of
  // the change, which is up to 5.
  for (const double dt_s : {1e-4, 3e-3, 0.03}) {
    Pixels pixels(50, 1);
    const auto start = pixels.floats;
    advance_pixels(step_of(quiet(), dt_s), pixels.block(), 50);
    for (std::size_t i = 0; i < 50; ++i) {
      const double i0 = start[1][i];
      const double i1 = 255 * start[0][i] / 5.0;
      const double u0 = start[2][i];
      const double u1 = test::ScalarPixel::log_intensity(i1, 20);
      const double k = rate_per_intensity(quiet()) * ((i0 + i1) / 2 + 20);
      double output = u0 + start[3][i];
      constexpr int kSubsteps = 20000;
      for (int n = 0; n < kSubsteps; ++n) {
        const double u = u0 + (u1 - u0) * (n + 0.5) / kSubsteps;
        output += (u - output) * k * dt_s / kSubsteps;
      }
      EXPECT_NEAR(pixels.floats[2][i] + pixels.floats[3][i], output, 1.5e-3);
      const double change = output - (u0 + start[3][i]);
      EXPECT_NEAR(pixels.floats[4][i] - start[4][i], change + 0.02 * dt_s, 1.5e-3);
    }
  }
}

TEST(PixelKernel, vector_code_and_its_scalar_remainder_give_the_same_bits) {
  for (const double cutoff_hz : {0.0, 30.0}) {
    PixelConfig config = quiet();
    config.cutoff_hz = cutoff_hz;
    constexpr std::size_t kCount = 100;
    Pixels at_once(kCount, 2);
    Pixels one_by_one(kCount, 2);
    advance_pixels(step_of(config, 2e-3), at_once.block(), kCount);
    for (std::size_t i = 0; i < kCount; ++i)
      advance_pixels(step_of(config, 2e-3), one_by_one.block(i), 1);
    EXPECT_EQ(at_once.floats, one_by_one.floats);
    EXPECT_EQ(at_once.crossed, one_by_one.crossed);
  }
}

TEST(PixelKernel, every_instruction_set_gives_the_same_bits) {
  for (const double cutoff_hz : {0.0, 30.0}) {
    PixelConfig config = quiet();
    config.cutoff_hz = cutoff_hz;
    constexpr std::size_t kCount = 5000;
    Pixels plain(kCount, 9);
    plain.floats[0][17] = std::numeric_limits<float>::quiet_NaN();
    const Pixels start = plain;
    const KernelStep step = step_of(config, 4e-3);
    const auto variants = kernel_variants();
    const auto run = [&](const KernelVariant& variant, Pixels& pixels) {
      const auto advance = step.low_pass ? variant.with_low_pass : variant.without_low_pass;
      EXPECT_EQ(advance(step, pixels.block(), kCount), 1u);
    };
    run(variants.front(), plain);
    for (std::size_t i = 1; i < variants.size(); ++i) {
      Pixels other = start;
      run(variants[i], other);
      for (const std::size_t result : {1, 2, 3, 4, 8, 9, 10, 11})
        EXPECT_EQ(other.floats[result], plain.floats[result]) << variants[i].name;
      EXPECT_EQ(other.crossed, plain.crossed) << variants[i].name;
    }
  }
}

TEST(PixelKernel, unusable_radiance_is_corrected_and_counted) {
  Pixels pixels(5, 3);
  const float before = pixels.floats[1][0];
  pixels.floats[0] = {std::numeric_limits<float>::quiet_NaN(),
                      std::numeric_limits<float>::infinity(),
                      -std::numeric_limits<float>::infinity(), -1.0f, 2.0f};
  const std::vector<float> last = pixels.floats[1];
  EXPECT_EQ(advance_pixels(step_of(quiet(), 1e-3), pixels.block(), 5), 4u);
  EXPECT_EQ(pixels.floats[1][0], before);
  EXPECT_EQ(pixels.floats[1][1], last[1]);
  EXPECT_EQ(pixels.floats[1][2], last[2]);
  EXPECT_EQ(pixels.floats[1][3], 0.0f);
  EXPECT_FLOAT_EQ(pixels.floats[1][4], 102.0f);
}

TEST(PixelKernel, log_is_linear_below_the_knee_and_continuous_at_it) {
  Pixels pixels(3, 4);
  pixels.floats[0] = {0.0f, 5 * 10.0f / 255, 5 * 20.0f / 255};
  settle_pixels(step_of(quiet(), 0), pixels.block(), 3);
  // Six ulp: scale, product and logarithm.
  EXPECT_NEAR(pixels.floats[2][0], 0.0, 1e-9);
  EXPECT_NEAR(pixels.floats[2][1], std::log(20.0) / 2, 1e-6);
  EXPECT_NEAR(pixels.floats[2][2], std::log(20.0), 2e-6);

  PixelConfig pure_log = quiet();
  pure_log.log_linear_below = 0;
  settle_pixels(step_of(pure_log, 0), pixels.block(), 3);
  EXPECT_NEAR(pixels.floats[2][0], std::log(0.01), 2e-6);
  EXPECT_NEAR(pixels.floats[2][1], std::log(10.0), 2e-6);
}

TEST(ResidualCourse, finds_the_crossing_to_the_tolerance) {
  core::Random random = core::random_stream(5, "crossing");
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const double rate = i % 4 == 0 ? 0 : std::exp(8 * core::uniform01(random) - 5);
    const double change = 2 * core::uniform01(random) - 1;
    const double lag = rate > 0 ? core::uniform01(random) - 0.5 : 0;
    const ResidualCourse course(change, 0.01, lag, 0.05, rate);
    const double end = course.residual(1);
    const double level = end > 0 ? 0.1 : -0.1;
    if (std::abs(end) < 0.1) continue;
    ++found;
    constexpr double kTolerance = 1e-5;
    const double s = course.crossing(0, 1, level, kTolerance);
    const double sign = level > 0 ? 1 : -1;
    EXPECT_LE(sign * (course.residual(std::max(0.0, s - kTolerance)) - level), 1e-12);
    EXPECT_GE(sign * (course.residual(std::min(1.0, s + kTolerance)) - level), -1e-12);
  }
  EXPECT_GT(found, 1000);
}

TEST(ResidualCourse, memorising_and_a_new_leak_leave_no_jump) {
  ResidualCourse course(0.3, 0.02, -0.1, 0.0, 1.5);
  const double level = course.residual(0.4);
  course.memorise(level);
  EXPECT_NEAR(course.residual(0.4), 0, 1e-15);
  const double later = course.residual(0.9);
  course.change_leak(0.4, 0.12);
  EXPECT_NEAR(course.residual(0.4), 0, 1e-15);
  EXPECT_NEAR(course.residual(0.9), later + 0.1 * 0.5, 1e-15);
}

}  // namespace
}  // namespace nightjar::sim
