#pragma once

#include <bit>
#include <cstdint>
#include <numbers>

/// Functions without branches or tables, so that a compiler turns a loop over them into
/// vector code, with the same bits on every processor.
namespace nightjar::esi {

/// log2(e): exp(x) is fast_exp2(kLog2E * x).
inline constexpr float kLog2E = static_cast<float>(std::numbers::log2e);

/// `a` where `condition`, else `b`; both are known, so there is nothing to branch for.
[[gnu::always_inline]] inline float select(bool condition, float a, float b) {
  const std::uint32_t mask = 0u - static_cast<std::uint32_t>(condition);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) |
                              (std::bit_cast<std::uint32_t>(b) & ~mask));
}

/// `x` within [least, greatest].
[[gnu::always_inline]] inline float bounded(float x, float least, float greatest) {
  const float raised = select(x > least, x, least);
  return select(raised < greatest, raised, greatest);
}

/// 2^x, to 1.5e-7 relative. Exactly 1 at 0, exactly 0 below -126.5, 2^126 from 126 on.
[[gnu::always_inline]] inline float fast_exp2(float x) {
  // x = n + r with |r| <= 1/2; the sum with 1.5 * 2^23 rounds to whole n.
  constexpr float kRound = 12582912.0f;
  const float near = bounded(x, -127.0f, 126.0f);
  const float shifted = near + kRound;
  const float r = near - (shifted - kRound);
  // 1 + r q(r), q minimax (off by 2e-9), in pairs: a shorter chain than Horner's.
  const float r2 = r * r;
  const float low = 6.931472029e-1f + 2.402264791e-1f * r;
  const float middle = 5.550332471e-2f + 9.618437357e-3f * r;
  const float high = 1.339887440e-3f + 1.535336195e-4f * r;
  const float p = 1.0f + r * (low + r2 * (middle + r2 * high));
  const std::uint32_t whole = (std::bit_cast<std::uint32_t>(shifted) << 23) + 0x3f800000u;
  return std::bit_cast<float>(whole) * p;  // 2^n, 0 for n = -127
}

/// log2 of a normal positive `x`, to 4e-7 absolute or 1e-7 relative. Exactly 0 at 1.
[[gnu::always_inline]] inline float fast_log2(double x) {
  // x = 2^n (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)).
  constexpr std::uint64_t kSqrtHalf = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t kFraction = 0x000fffffffffffff;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) - kSqrtHalf;
  const auto n =
      static_cast<float>(static_cast<std::int32_t>(static_cast<std::int64_t>(bits) >> 52));
  const auto f = static_cast<float>(std::bit_cast<double>((bits & kFraction) + kSqrtHalf) - 1.0);
  // f q(f), q minimax (f q off by 1e-7), in pairs.
  const float f2 = f * f;
  const float low = 1.442694922f - 7.213524874e-1f * f;
  const float middle = 4.809311622e-1f - 3.602634619e-1f * f;
  const float high = 2.868688763e-1f - 2.483228119e-1f * f;
  const float highest = 2.357096360e-1f - 1.497332622e-1f * f;
  return n + f * (low + f2 * (middle + f2 * (high + f2 * highest)));
}

/// The nearest float or its neighbour: processors before AVX-512 convert signed integers only.
[[gnu::always_inline]] inline float to_float(std::uint32_t value) {
  const auto high = static_cast<float>(static_cast<std::int32_t>(value >> 16));
  const auto low = static_cast<float>(static_cast<std::int32_t>(value & 0xffffu));
  return high * 65536.0f + low;
}

/// The nearest of 256 grey levels to `level`, which may lie beyond them.
[[gnu::always_inline]] inline std::uint8_t to_gray(float level) {
  return static_cast<std::uint8_t>(static_cast<std::int32_t>(bounded(level, 0.0f, 255.0f) + 0.5f));
}

}  // namespace nightjar::esi
