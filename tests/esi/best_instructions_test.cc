#include "esi/best_instructions.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

std::vector<float> powers(const std::vector<float>& exponents, core::InstructionSets sets) {
  std::vector<float> all(exponents.size());
  const float* from = exponents.data();
  float* to = all.data();
  const std::size_t count = all.size();
  with_best_instructions(
      [=]() __attribute__((always_inline)) {
#pragma GCC ivdep
        for (std::size_t i = 0; i < count; ++i) to[i] = fast_exp2(0.7f * from[i] + 0.1f);
      },
      sets);
  return all;
}

TEST(BestInstructions, give_the_same_bits_with_every_set) {
  core::Random random = core::random_stream(/*seed=*/1, "test.best_instructions");
  std::vector<float> exponents(1003);  // not a whole number of registers
  for (float& x : exponents) x = static_cast<float>(200 * core::uniform01(random) - 100);
  const auto expected = powers(exponents, {});
  const core::InstructionSets here = core::instruction_sets();
  EXPECT_EQ(powers(exponents, {.avx2 = here.avx2, .avx512 = false}), expected);
  EXPECT_EQ(powers(exponents, here), expected);
  EXPECT_EQ(expected[0], fast_exp2(0.7f * exponents[0] + 0.1f));
}

}  // namespace
}  // namespace nightjar::esi
