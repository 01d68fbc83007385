#include "sim/pixel_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "sim/pixel_math.h"
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

TEST(PixelMath, logarithm_is_good_to_single_precision) {
  for (double x = 1e-3; x < 1e6; x *= 1.0007) {
    const auto value = static_cast<float>(x);
    const double truth = std::log(static_cast<double>(value));
    // 2 ulp of a float, absolute near the zero at 1.
    const double tolerance = 2.4e-7 * std::max(1.0, std::abs(truth));
    EXPECT_NEAR(fast_log<Fused>(value), truth, tolerance) << x;
    EXPECT_NEAR(fast_log<Apart>(value), truth, tolerance) << x;
  }
}

TEST(PixelMath, square_root_is_good_to_five_millionths) {
  for (double x = 1e-30; x < 1e30; x *= 1.003) {
    const double truth = std::sqrt(static_cast<double>(static_cast<float>(x)));
    EXPECT_NEAR(fast_sqrt(static_cast<float>(x)), truth, 5e-6 * truth) << x;
  }
  EXPECT_EQ(fast_sqrt(0.0f), 0.0f);
}

TEST(PixelMath, normal_pair_is_what_box_and_muller_say) {
  core::Random random = core::random_stream(4, "normal_pair");
  constexpr double kPi = std::numbers::pi;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    const auto low = static_cast<std::uint32_t>(bits);
    // Among them the smallest radii there are.
    const auto high =
        i < 1000 ? ~static_cast<std::uint32_t>(i) : static_cast<std::uint32_t>(bits >> 32);
    const double radius = std::sqrt(-2 * std::log((std::floor(high / 2.0) + 0.5) * 0x1p-31));
    const double angle = static_cast<std::int32_t>(low << 2) * kPi * 0x1p-33;
    const double quarter = low & 0x40000000u ? std::sin(angle) : std::cos(angle);
    const double other = low & 0x40000000u ? std::cos(angle) : std::sin(angle);
    const double cosine_sign = low & 0x80000000u ? -1 : 1;
    const auto [first, second] = fast_normal_pair(high, low);
    // The root's 5e-6, and what rounding u to 24 bits does to a small radius: the square is off by
    // up to 2^-23, or 2^-24 near u = 1, where all up to sqrt(2^-24) = 2.4e-4 becomes 0.
    const double tolerance = 5e-6 * radius + std::min(0x1p-24 / radius, 3e-4);
    EXPECT_NEAR(first, radius * quarter * (low & 0x40000000u ? 1 : cosine_sign), tolerance);
    EXPECT_NEAR(second, radius * other * (low & 0x40000000u ? cosine_sign : 1), tolerance);
  }
}

/// Counts of 2 n deviates from -6 to 6 in steps of 1/4, first and last with all beyond.
std::array<double, 48> normal_histogram(std::uint64_t seed, int n) {
  core::Random random = core::random_stream(seed, "normal_pair");
  std::array<double, 48> counts{};
  const auto add = [&](float x) { ++counts[std::clamp(static_cast<int>(4 * x + 24), 0, 47)]; };
  for (int i = 0; i < n; ++i) {
    const std::uint64_t bits = random();
    const auto [first, second] =
        fast_normal_pair(static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits));
    add(first);
    add(second);
  }
  return counts;
}

TEST(PixelMath, normal_pair_is_normal_far_into_its_tails) {
  constexpr int kPairs = 5'000'000;
  const std::array<double, 48> counts = normal_histogram(5, kPairs);
  const auto below = [](double x) { return std::erfc(-x / std::numbers::sqrt2) / 2; };
  for (int i = 0; i < 48; ++i) {
    const double from = i == 0 ? 0 : below(i / 4.0 - 6),
                 to = i == 47 ? 1 : below((i + 1) / 4.0 - 6);
    const double expected = 2 * kPairs * (to - from);
    // 5 deviations of Poisson; where few are expected, 5 more.
    EXPECT_NEAR(counts[i], expected, 5 * std::sqrt(expected) + 5) << i / 4.0 - 6;
  }
  EXPECT_GT(counts[4] + counts[43], 0);  // beyond 4.75 deviations: 20 of ten million
  EXPECT_NEAR(fast_normal_pair(0, 0).first, 6.66, 0.01);
}

TEST(PixelMath, both_of_a_normal_pair_are_independent) {
  constexpr int kPairs = 1'000'000;
  core::Random random = core::random_stream(6, "normal_pair");
  double product = 0, squares = 0, signs = 0;
  for (int i = 0; i < kPairs; ++i) {
    const std::uint64_t bits = random();
    const auto [a, b] =
        fast_normal_pair(static_cast<std::uint32_t>(bits >> 32), static_cast<std::uint32_t>(bits));
    product += double{a} * b;
    squares += (double{a} * a - 1) * (double{b} * b - 1) / 2;
    signs += (a < 0) == (b < 0) ? 1 : -1;
  }
  for (const double sum : {product, squares, signs})  // each term has the deviation 1
    EXPECT_NEAR(sum, 0, 5 * std::sqrt(kPairs));
}

TEST(PixelMath, one_minus_exp_keeps_its_relative_precision_down_to_nothing) {
  for (double a = 1e-9; a < 80; a *= 1.003) {
    const auto value = static_cast<float>(a);
    const double truth = -std::expm1(-static_cast<double>(value));
    EXPECT_NEAR(fast_one_minus_exp(value), truth, 2.4e-7 * truth) << a;  // 2 ulp
  }
  EXPECT_EQ(fast_one_minus_exp(0.0f), 0.0f);
}

TEST(PixelMath, mean_of_an_exponential_is_good_to_single_precision) {
  for (double a = 1e-9; a <= 1; a *= 1.003) {
    const auto value = static_cast<float>(a);
    const double truth = -std::expm1(-static_cast<double>(value)) / static_cast<double>(value);
    EXPECT_NEAR(fast_mean_exp(value), truth, 2.4e-7 * truth) << a;  // 2 ulp
  }
}

TEST(PixelMath, logarithmic_mean_comes_without_a_division) {
  for (double d = -1; d <= 1; d += 0.01) {
    const double a = 100, b = a * std::exp(d), mean = (a + b) / 2;
    const double truth = mean - (std::abs(d) < 1e-6 ? mean : (b - a) / d);
    // 4e-6 of the polynomial, the rest single precision.
    EXPECT_NEAR(log_mean_deficit(static_cast<float>(b - a), static_cast<float>(d)), truth,
                4.2e-6 * mean)
        << d;
  }
}

TEST(PixelMath, exponential_is_good_to_double_precision) {
  for (double a = 1e-9; a < 700; a *= 1.003) {
    const double truth = std::exp(-a);
    // The series stops at 7e-15; the reduction by a multiple of ln 2 is exact to 1e-16 a.
    EXPECT_NEAR(fast_exp_minus(a), truth, (1e-14 + 1e-16 * a) * truth) << a;
  }
  for (double a = -700; a < 0; a += 0.37)
    EXPECT_NEAR(fast_exp_minus(a), std::exp(-a), (1e-14 - 1e-16 * a) * std::exp(-a)) << a;
  EXPECT_EQ(fast_exp_minus(0), 1);
  EXPECT_LT(fast_exp_minus(1e9), 1e-300);
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
