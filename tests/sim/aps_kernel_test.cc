#include "sim/aps_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

// Not a multiple of any vector's length.
constexpr std::uint32_t kCount = kApsBatch - 3;

using Floats = std::array<float, kApsBatch>;

Floats uniform(std::uint64_t seed, float most) {
  core::Random random = core::random_stream(seed, "aps_kernel_test");
  Floats values;
  for (float& value : values) value = most * static_cast<float>(core::uniform01(random));
  return values;
}

ApsDraws draws(std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "aps_kernel_test");
  ApsDraws all;
  for (std::uint32_t i = 0; i < kApsBatch / 2; ++i) {
    all.high[i] = static_cast<std::uint32_t>(random());
    all.low[i] = static_cast<std::uint32_t>(random());
  }
  return all;
}

/// 10 lux and its like, among them what is no luminance.
Floats luminance_lux() {
  Floats lux = uniform(1, 10);
  lux[3] = std::numeric_limits<float>::quiet_NaN();
  lux[4] = -1;
  lux[5] = std::numeric_limits<float>::infinity();
  lux[6] = -std::numeric_limits<float>::infinity();
  lux[7] = -0.0f;
  lux[kCount - 1] = -2;
  return lux;
}

TEST(ApsKernel, takes_light_and_counts_what_is_none) {
  const Floats lux = luminance_lux();
  for (const ApsVariant& variant : aps_variants()) {
    Floats light{};
    EXPECT_EQ(variant.take(lux.data(), kCount, light.data()), 5u) << variant.name;
    EXPECT_EQ(light[2], lux[2]);
    for (const int i : {3, 4, 6, 7}) EXPECT_EQ(light[i], 0) << variant.name << ' ' << i;
    EXPECT_EQ(light[5], 1e12f);
    EXPECT_EQ(light[kCount - 1], 0);
    EXPECT_EQ(light[kCount], 0) << "beyond the last";
  }
}

TEST(ApsKernel, integrates_both_ends_of_a_step) {
  const Floats before = uniform(2, 10), lux = luminance_lux(), charge = uniform(3, 1);
  for (const ApsVariant& variant : aps_variants()) {
    Floats sum = charge;
    variant.integrate(before.data(), 0.25f, lux.data(), 0.5f, kCount, sum.data());
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const float light = lux[i] > 0 ? std::min(lux[i], 1e12f) : 0.0f;
      EXPECT_EQ(sum[i], charge[i] + (0.25f * before[i] + 0.5f * light)) << variant.name << ' ' << i;
    }
    EXPECT_EQ(sum[kCount], charge[kCount]) << "beyond the last";
  }
}

TEST(ApsKernel, reads_charge_with_noise_in_the_converters_range) {
  const ApsConversion conversion{.read_variance_e2 = 44 * 44,
                                 .full_well_e = 25000,
                                 .codes_per_e = 959 / 25000.0f,
                                 .black_codes = 64,
                                 .most_codes = 1000,
                                 .dropped_bits = 0};
  const Floats charge = uniform(4, 9), gain = uniform(5, 4000), offset = uniform(6, 100);
  const ApsDraws noise = draws(7);
  for (const ApsVariant& variant : aps_variants()) {
    Floats left = charge;
    std::array<std::uint16_t, kApsBatch> gray{};
    variant.read(conversion, noise, gain.data(), offset.data(), kCount, left.data(), gray.data());
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const std::uint32_t k = i % (kApsBatch / 2);
      const NormalPair pair = fast_normal_pair(noise.high[k], noise.low[k]);
      const double photo_e = double{charge[i]} * gain[i];
      const double noise_e = std::sqrt(photo_e + 44 * 44) * (i == k ? pair.first : pair.second);
      const double code = 64 + 959 / 25000.0 * std::min(photo_e + noise_e + offset[i], 25000.0);
      // A code is rounded from a number off by 1.3e-4 for the root's 5e-6 of up to 700 electrons,
      // and by seven roundings of up to 25,000 electrons or 1000 codes: 3e-5 to 4e-5 codes each.
      const double tolerance = 0.5 + 4e-4;
      EXPECT_NEAR(gray[i], std::clamp(code, 0.0, 1000.0), tolerance) << variant.name << ' ' << i;
      EXPECT_EQ(left[i], 0);
    }
    EXPECT_EQ(gray[kCount], 0) << "beyond the last";
    EXPECT_EQ(left[kCount], charge[kCount]);
  }
}

TEST(ApsKernel, every_instruction_set_gives_the_same_bits) {
  const std::vector<ApsVariant> variants = aps_variants();
  const Floats lux = luminance_lux(), before = uniform(8, 10), gain = uniform(9, 4000),
               offset = uniform(10, 100);
  const ApsConversion conversion{.read_variance_e2 = 1e4f, .dropped_bits = 2};
  struct Result {
    Floats light{}, charge{};
    std::array<std::uint16_t, kApsBatch> gray{};
  };
  const auto result = [&](const ApsVariant& variant) {
    Result r;
    variant.take(lux.data(), kCount, r.light.data());
    Floats charge = uniform(11, 1);
    variant.integrate(before.data(), 0.3f, lux.data(), 0.7f, kCount, charge.data());
    r.charge = charge;
    variant.read(conversion, draws(12), gain.data(), offset.data(), kCount, charge.data(),
                 r.gray.data());
    return r;
  };
  const Result plain = result(variants.front());
  for (const ApsVariant& variant : variants) {
    const Result other = result(variant);
    EXPECT_EQ(other.light, plain.light) << variant.name;
    EXPECT_EQ(other.charge, plain.charge) << variant.name;
    EXPECT_EQ(other.gray, plain.gray) << variant.name;
  }
}

}  // namespace
}  // namespace nightjar::sim
