#include "sim/pixel_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/random.h"
#include "tests/support/sim_scalar_pixel.h"

namespace nightjar::sim {
namespace {

constexpr std::uint32_t kCount = PixelBlock::kPixels;

/// Input and a plausible state for a kernel call.
struct Pixels {
  explicit Pixels(std::uint64_t seed) {
    core::Random random = core::random_stream(seed, "kernel_test");
    const auto uniform = [&] { return static_cast<float>(core::uniform01(random)); };
    std::array<float, kCount> before;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      luminance_lux[i] = 5 * uniform();
      before[i] = 255 * uniform();
    }
    const PixelConfig config = preset_pixel(SensorPreset::dim, 5);
    settle_pixels(kernel_step(config, 255.0), before.data(), kCount, block);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      block.lag[i] = uniform() - 0.5f;
      block.residual[i] = 0.2f * uniform() - 0.1f;
      block.threshold_on[i] = block.threshold_off[i] = 0.2f;
      block.leak_per_s[i] = 0.02f;
    }
  }

  std::array<float, kCount> luminance_lux;
  PixelBlock block = {};
  BlockStep step = {};
};

void expect_same_bits(const Pixels& a, const Pixels& b, const char* name) {
  EXPECT_EQ(std::memcmp(&a.block, &b.block, sizeof(PixelBlock)), 0) << name;
  EXPECT_EQ(std::memcmp(&a.step, &b.step, sizeof(BlockStep)), 0) << name;
}

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

TEST(PixelKernel, a_step_of_any_length_agrees_with_v2e_in_tiny_steps) {
  // v2e's Euler update with 20,000 substeps; its own error is k dt / 20,000 < 3e-4 of
  // the change, which is up to 5. The shortest steps take the kernel's polynomial.
  for (const double dt_s : {1e-4, 3e-3, 0.03}) {
    const Pixels start(1);
    Pixels pixels = start;
    advance_pixels(step_of(quiet(), dt_s), pixels.luminance_lux.data(), 50, pixels.block,
                   pixels.step);
    for (std::size_t i = 0; i < 50; ++i) {
      const double i0 = start.block.intensity[i];
      const double i1 = 255 * start.luminance_lux[i] / 5.0;
      const double u0 = start.block.log_intensity[i];
      const double u1 = test::ScalarPixel::log_intensity(i1, 20);
      const double k =
          rate_per_intensity(quiet()) * (test::ScalarPixel::mean_intensity(i0, i1, 20) + 20);
      double output = u0 + start.block.lag[i];
      constexpr int kSubsteps = 20000;
      for (int n = 0; n < kSubsteps; ++n) {
        const double u = u0 + (u1 - u0) * (n + 0.5) / kSubsteps;
        output += (u - output) * k * dt_s / kSubsteps;
      }
      EXPECT_NEAR(pixels.block.log_intensity[i] + pixels.block.lag[i], output, 1.5e-3);
      const double change = output - (u0 + start.block.lag[i]);
      EXPECT_NEAR(pixels.block.residual[i] - start.block.residual[i], change + 0.02 * dt_s, 1.5e-3);
    }
  }
}

TEST(PixelKernel, photoreceptor_has_its_closed_form_at_every_k_dt) {
  for (const double dt_s : {1e-5, 2e-3, 5e-3, 7e-3, 0.01, 0.015, 0.1, 3.0}) {
    const Pixels start(7);
    Pixels pixels = start;
    advance_pixels(step_of(quiet(), dt_s), pixels.luminance_lux.data(), kCount, pixels.block,
                   pixels.step);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const double mean = test::ScalarPixel::mean_intensity(start.block.intensity[i],
                                                            pixels.block.intensity[i], 20);
      const double kdt = rate_per_intensity(quiet()) * (mean + 20) * dt_s;
      const double truth =
          start.block.lag[i] * std::exp(-kdt) + pixels.step.change[i] * std::expm1(-kdt) / kdt;
      // A few ulp of changes up to 5, and the rate's own 5e-5 of half a kdt or of the lag.
      EXPECT_NEAR(pixels.block.lag[i], truth, 4e-6 + 2e-5 * std::abs(pixels.step.change[i])) << kdt;
    }
  }
}

TEST(PixelKernel, the_most_light_there_can_be_stays_finite) {
  PixelConfig config = quiet();
  config.cutoff_hz = 1e5;
  KernelStep step = kernel_step(config, 1e-6);
  set_step(step, config, 3600);
  Pixels pixels(6);
  pixels.luminance_lux.fill(1e20f);
  for (int i = 0; i < 3; ++i)
    advance_pixels(step, pixels.luminance_lux.data(), kCount, pixels.block, pixels.step);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(pixels.block.log_intensity[i], std::log(2.55e28), 1e-5);
    EXPECT_NEAR(pixels.block.lag[i], 0, 1e-6);
    EXPECT_TRUE(std::isfinite(pixels.block.residual[i]));
  }
}

TEST(PixelKernel, polynomial_and_exponential_agree_where_one_gives_way_to_the_other) {
  // One pixel just above k dt = 1 brings the whole block over to the exponential.
  const KernelStep step = step_of(quiet(), 1 / (rate_per_intensity(quiet()) * 275));
  Pixels below(8);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    below.luminance_lux[i] *= 0.99f;
    below.block.intensity[i] *= 0.99f;
    below.block.log_intensity[i] = static_cast<float>(
        test::ScalarPixel::log_intensity(static_cast<double>(below.block.intensity[i]), 20));
  }
  Pixels above = below;
  above.luminance_lux[kCount - 1] = 6;
  above.block.intensity[kCount - 1] = 300;
  above.block.log_intensity[kCount - 1] = std::log(300.0f);
  advance_pixels(step, below.luminance_lux.data(), kCount, below.block, below.step);
  advance_pixels(step, above.luminance_lux.data(), kCount, above.block, above.step);
  for (std::uint32_t i = 0; i + 1 < kCount; ++i)
    EXPECT_NEAR(above.block.lag[i], below.block.lag[i], 1e-6);  // a few ulp of changes up to 5
}

TEST(PixelKernel, vector_code_and_its_scalar_remainder_give_the_same_bits) {
  for (const double cutoff_hz : {0.0, 30.0}) {
    PixelConfig config = quiet();
    config.cutoff_hz = cutoff_hz;
    const KernelStep step = step_of(config, 2e-3);
    Pixels whole(2), part(2);
    advance_pixels(step, whole.luminance_lux.data(), kCount, whole.block, whole.step);
    for (std::uint32_t count = 1; count < 40; ++count) {
      part = Pixels(2);
      std::ranges::fill(part.step.crossed, std::uint8_t{1});  // as a step before left it
      advance_pixels(step, part.luminance_lux.data(), count, part.block, part.step);
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(part.block.residual[i], whole.block.residual[i]);
        EXPECT_EQ(part.block.lag[i], whole.block.lag[i]);
        EXPECT_EQ(part.step.crossed[i], whole.step.crossed[i]);
      }
      EXPECT_EQ(part.block.residual[count], Pixels(2).block.residual[count]);
      for (std::uint32_t i = count; i < kCount; ++i) EXPECT_EQ(part.step.crossed[i], 0);
    }
  }
}

TEST(PixelKernel, every_instruction_set_gives_the_same_bits) {
  for (const double cutoff_hz : {0.0, 30.0, 3000.0}) {  // none, polynomial, exponential
    PixelConfig config = quiet();
    config.cutoff_hz = cutoff_hz;
    const KernelStep step = step_of(config, 4e-3);
    const Pixels start(9);
    const auto run = [&](const KernelVariant& variant) {
      Pixels pixels = start;
      const auto advance = step.low_pass ? variant.with_low_pass : variant.without_low_pass;
      advance(step, pixels.luminance_lux.data(), kCount, pixels.block, pixels.step);
      return pixels;
    };
    const auto variants = kernel_variants();
    const Pixels plain = run(variants.front());
    for (const KernelVariant& variant : variants)
      expect_same_bits(run(variant), plain, variant.name);
  }
}

TEST(PixelKernel, intensities_between_have_the_same_bits_on_every_instruction_set) {
  const KernelStep step = kernel_step(quiet(), 5.0);
  const Pixels from(3), to(4);
  const auto run = [&](const KernelVariant& variant) {
    std::vector<float> between(kCount);
    variant.between(step, from.luminance_lux.data(), to.luminance_lux.data(), 0.3f, kCount,
                    between.data());
    return between;
  };
  const auto variants = kernel_variants();
  for (const KernelVariant& variant : variants)
    EXPECT_EQ(run(variant), run(variants.front())) << variant.name;
}

TEST(PixelKernel, every_instruction_set_leaves_alone_what_has_to_be_corrected) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const KernelStep step = step_of(quiet(), 2e-3);
  Pixels start(3);
  const auto plain = start.luminance_lux;
  settle_pixels(step, plain.data(), kCount, start.block);
  for (const KernelVariant& variant : kernel_variants())
    for (const auto advance : {variant.with_low_pass, variant.without_low_pass}) {
      Pixels usable = start;
      EXPECT_TRUE(advance(step, plain.data(), kCount, usable.block, usable.step)) << variant.name;
      for (const float bad :
           {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, -1.0f, -0.0f, 1.1e20f})
        for (const std::uint32_t i : {0u, 17u, kCount - 1}) {
          Pixels pixels = start;
          pixels.luminance_lux.fill(2.0f);
          pixels.luminance_lux[i] = bad;
          EXPECT_FALSE(
              advance(step, pixels.luminance_lux.data(), kCount, pixels.block, pixels.step))
              << variant.name << ' ' << bad;
          EXPECT_EQ(std::memcmp(&pixels.block, &start.block, sizeof(PixelBlock)), 0);
        }
    }
}

TEST(PixelKernel, minus_zero_is_plain_zero) {
  Pixels minus(3), plus(3);
  minus.luminance_lux[5] = -0.0f;
  plus.luminance_lux[5] = 0.0f;
  // All go through the correction, where the scale is applied beforehand.
  minus.luminance_lux[6] = plus.luminance_lux[6] = -1.0f;
  const KernelStep step = step_of(quiet(), 1e-3);
  for (Pixels* pixels : {&minus, &plus}) {
    const BadInputs bad =
        advance_pixels(step, pixels->luminance_lux.data(), kCount, pixels->block, pixels->step);
    EXPECT_EQ(bad.negative, 1u);
    EXPECT_EQ(bad.not_finite, 0u);
  }
  expect_same_bits(minus, plus, "minus 0");
  minus = plus = Pixels(3);
  minus.luminance_lux[5] = -0.0f;
  plus.luminance_lux[5] = 0.0f;
  for (Pixels* pixels : {&minus, &plus})
    advance_pixels(step, pixels->luminance_lux.data(), kCount, pixels->block, pixels->step);
  expect_same_bits(minus, plus, "minus 0 alone");
  EXPECT_EQ(minus.block.intensity[5], 0.0f);
}

TEST(PixelKernel, correction_works_also_where_the_scale_goes_beyond_the_limit) {
  // 1e16 lux under a white of 1e-3 are an intensity of 2.55e21.
  KernelStep step = kernel_step(quiet(), 1e-3);
  set_step(step, quiet(), 1e-3);
  Pixels pixels(3);
  const PixelBlock before = pixels.block;
  pixels.luminance_lux[0] = std::numeric_limits<float>::quiet_NaN();
  pixels.luminance_lux[1] = 1e16f;
  const BadInputs bad =
      advance_pixels(step, pixels.luminance_lux.data(), kCount, pixels.block, pixels.step);
  EXPECT_EQ(bad.not_finite, 1u);
  EXPECT_EQ(pixels.block.intensity[0], before.intensity[0]);
  EXPECT_FLOAT_EQ(pixels.block.intensity[1], 2.55e21f);
  EXPECT_FLOAT_EQ(pixels.block.intensity[2], pixels.luminance_lux[2] * 2.55e5f);
}

/// Lag of a photoreceptor, settled or not, after a step from `i0` to `i1` with a rate
/// constant that follows the intensity all the way: exponentials over tiny parts.
double true_lag(double i0, double i1, double lag, double dt_s, double knee) {
  const double from = test::ScalarPixel::log_intensity(i0, knee);
  const double change = test::ScalarPixel::log_intensity(i1, knee) - from;
  constexpr int kParts = 20'000;
  for (int n = 0; n < kParts; ++n) {
    const double log = from + change * (n + 0.5) / kParts;
    const double at_knee = std::log(knee);
    const double intensity = log <= at_knee ? log * knee / at_knee : std::exp(log);
    const double kdt = rate_per_intensity(quiet()) * (intensity + 20) * dt_s / kParts;
    lag = lag * std::exp(-kdt) + change / kParts * std::expm1(-kdt) / kdt;
  }
  return lag;
}

TEST(PixelKernel, a_lag_decays_by_the_integral_of_the_rate_over_the_step) {
  // Two pixels that differ in their lag alone: what is left of the difference. Above the
  // knee, below it and through it, up and down, far and hardly at all.
  // The logarithm's change is just below 1 in one, just above in another.
  constexpr std::array<std::array<float, 2>, 10> kSteps{{{250, 22},
                                                         {22, 250},
                                                         {3, 15},
                                                         {250, 2},
                                                         {0, 250},
                                                         {100, 101},
                                                         {100, 103},
                                                         {90, 244},
                                                         {90, 245},
                                                         {19.9f, 20.1f}}};
  for (const double dt_s : {1e-3, 5e-3, 0.033})
    for (const auto& [before, after] : kSteps) {
      Pixels pixels(11);
      pixels.block.lag[0] = 0;
      pixels.block.lag[1] = 1;
      for (const int i : {0, 1}) {
        pixels.block.intensity[i] = before;
        pixels.block.log_intensity[i] =
            static_cast<float>(test::ScalarPixel::log_intensity(static_cast<double>(before), 20));
        pixels.luminance_lux[static_cast<std::size_t>(i)] = after * 5 / 255;
      }
      advance_pixels(step_of(quiet(), dt_s), pixels.luminance_lux.data(), 2, pixels.block,
                     pixels.step);
      const double left =
          true_lag(before, after, 1, dt_s, 20) - true_lag(before, after, 0, dt_s, 20);
      // The rate is off by 5e-6 from the polynomial, by 3e-5 from a long way through the knee, by
      // 6e-4 with the ends so close about it; x exp(-x) < 0.37.
      const double tolerance = before == 19.9f ? 3e-4 : 2e-5;
      EXPECT_NEAR(pixels.block.lag[1] - pixels.block.lag[0], left, tolerance)
          << before << ' ' << after;
    }
}

TEST(PixelKernel, intensities_between_go_straight_in_the_logarithm) {
  for (const double knee : {20.0, 0.0}) {
    PixelConfig config = quiet();
    config.log_linear_below = knee;
    const KernelStep step = kernel_step(config, 5.0);
    const std::array<float, 5> before{10, 1, 250, 0, 100}, after{200, 15, 22, 120, 100};
    for (const float share : {0.0f, 0.25f, 0.8f, 1.0f}) {
      std::array<float, 5> between;
      intensities_between(step, before.data(), after.data(), share, 5, between.data());
      for (std::size_t i = 0; i < between.size(); ++i) {
        const auto log = [&](double intensity) {
          return knee > 0 ? test::ScalarPixel::log_intensity(intensity, knee)
                          : std::log(std::max(intensity, 0.01));
        };
        const double expected =
            log(before[i]) + (log(after[i]) - log(before[i])) * static_cast<double>(share);
        EXPECT_NEAR(log(between[i]), expected, 3e-6) << i;  // a few ulp of logarithms up to 5.5
      }
    }
  }
}

TEST(PixelKernel, unusable_radiance_is_corrected_and_counted) {
  Pixels pixels(3);
  const PixelBlock before = pixels.block;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  pixels.luminance_lux = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, -1.0f,
                          2.0f};
  const BadInputs bad = advance_pixels(step_of(quiet(), 1e-3), pixels.luminance_lux.data(), 5,
                                       pixels.block, pixels.step);
  EXPECT_EQ(bad.negative, 1u);
  EXPECT_EQ(bad.not_finite, 3u);
  for (const int last : {0, 1, 2}) EXPECT_EQ(pixels.block.intensity[last], before.intensity[last]);
  EXPECT_EQ(pixels.block.intensity[3], 0.0f);
  EXPECT_FLOAT_EQ(pixels.block.intensity[4], 102.0f);
}

TEST(PixelKernel, log_is_linear_below_the_knee_and_continuous_at_it) {
  PixelBlock block = {};
  const std::array<float, 3> luminance_lux{0.0f, 5 * 10.0f / 255, 5 * 20.0f / 255};
  settle_pixels(step_of(quiet(), 0), luminance_lux.data(), 3, block);
  // Six ulp: scale, product and logarithm.
  EXPECT_NEAR(block.log_intensity[0], 0.0, 1e-9);
  EXPECT_NEAR(block.log_intensity[1], std::log(20.0) / 2, 1e-6);
  EXPECT_NEAR(block.log_intensity[2], std::log(20.0), 2e-6);

  PixelConfig pure_log = quiet();
  pure_log.log_linear_below = 0;
  settle_pixels(step_of(pure_log, 0), luminance_lux.data(), 3, block);
  EXPECT_NEAR(block.log_intensity[0], std::log(0.01), 2e-6);
  EXPECT_NEAR(block.log_intensity[1], std::log(10.0), 2e-6);
}

}  // namespace
}  // namespace nightjar::sim
