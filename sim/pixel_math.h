#pragma once

#include <bit>
#include <cstdint>

/// Single-precision functions without branches or tables, so that a compiler turns a
/// loop over them into vector code, with the same bits on every processor.
namespace nightjar::sim {

/// `a` where `condition`, else `b`; both are known, so there is nothing to branch for.
[[gnu::always_inline]] inline float select(bool condition, float a, float b) {
  const std::uint32_t mask = 0u - static_cast<std::uint32_t>(condition);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) |
                              (std::bit_cast<std::uint32_t>(b) & ~mask));
}

/// Natural logarithm of a normal positive `x`, to 2e-7 relative or 1e-7 absolute.
[[gnu::always_inline]] inline float fast_log(float x) {
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)).
  constexpr std::uint32_t kSqrtHalf = 0x3f3504f3;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - kSqrtHalf;
  const float e = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float f = std::bit_cast<float>((bits & 0x007fffffu) + kSqrtHalf) - 1.0f;
  // Minimax of log(1 + f) (Cephes, logf.c).
  float p = 7.0376836292e-2f;
  p = p * f - 1.1514610310e-1f;
  p = p * f + 1.1676998740e-1f;
  p = p * f - 1.2420140846e-1f;
  p = p * f + 1.4249322787e-1f;
  p = p * f - 1.6668057665e-1f;
  p = p * f + 2.0000714765e-1f;
  p = p * f - 2.4999993993e-1f;
  p = p * f + 3.3333331174e-1f;
  const float z = f * f;
  // ln 2 in two parts keeps e ln 2 exact to the last bit.
  const float small = f * z * p + e * -2.12194440e-4f - 0.5f * z;
  return f + small + e * 0.693359375f;
}

/// 1 - exp(-a) for a in [0, 80], to 2e-7 relative also where a is tiny.
[[gnu::always_inline]] inline float fast_one_minus_exp(float a) {
  // -a = n ln 2 + r with |r| <= ln 2 / 2; the sum with 1.5 * 2^23 rounds to whole n.
  constexpr float kRound = 12582912.0f;
  const float shifted = a * -1.44269504f + kRound;
  const float n = shifted - kRound;
  const float r = (-a - n * 0.693359375f) - n * -2.12194440e-4f;
  // exp(r) - 1 (Cephes, expf.c).
  float p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  const float growth = r * r * p + r;
  const std::uint32_t whole = std::bit_cast<std::uint32_t>(shifted) << 23;
  const float power = std::bit_cast<float>(whole + 0x3f800000u);  // 2^n
  return (1.0f - power) - power * growth;
}

}  // namespace nightjar::sim
