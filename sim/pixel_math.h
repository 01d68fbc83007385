#pragma once

#include <bit>
#include <cstdint>

/// Functions without branches or tables, so that a compiler turns a loop over them into
/// vector code, with the same bits on every processor.
namespace nightjar::sim {

/// `a` where `condition`, else `b`; both are known, so there is nothing to branch for.
[[gnu::always_inline]] inline float select(bool condition, float a, float b) {
  const std::uint32_t mask = 0u - static_cast<std::uint32_t>(condition);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) |
                              (std::bit_cast<std::uint32_t>(b) & ~mask));
}

[[gnu::always_inline]] inline double select(bool condition, double a, double b) {
  const std::uint64_t mask = 0u - static_cast<std::uint64_t>(condition);
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) |
                               (std::bit_cast<std::uint64_t>(b) & ~mask));
}

/// a b + c, rounded once: one operation, or where the processor has none (x86 before 2013) a
/// call that takes some ten times as long; the same bits everywhere.
struct Fused {
  [[gnu::always_inline]] float operator()(float a, float b, float c) const {
    return __builtin_fmaf(a, b, c);
  }
};
/// a b + c, rounded twice.
struct Apart {
  [[gnu::always_inline]] float operator()(float a, float b, float c) const { return a * b + c; }
};

/// Natural logarithm of a normal positive `x`, to 2e-7 relative or 1e-7 absolute.
template <class MultiplyAdd>
[[gnu::always_inline]] inline float fast_log(float x) {
  constexpr MultiplyAdd fma;
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)).
  constexpr std::uint32_t kSqrtHalf = 0x3f3504f3;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - kSqrtHalf;
  const float e = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float f = std::bit_cast<float>((bits & 0x007fffffu) + kSqrtHalf) - 1.0f;
  // log(1 + f) = f - f^2/2 + f^3 p; minimax of it (off by 7e-9), in pairs: a shorter chain
  // than Horner's.
  const float z = f * f;
  const float low = fma(fma(f, -1.6564425607e-1f, 1.9954875737e-1f), z,
                        fma(f, -2.5001698740e-1f, 3.3334165916e-1f));
  const float high = fma(8.6721878761e-2f, z, fma(f, -1.4379008442e-1f, 1.4977992947e-1f));
  const float p = fma(high, z * z, low);
  return fma(e, 6.9314718056e-1f, fma(fma(f, p, -0.5f), z, f));
}

/// Square root of `x`, 0 or from 1e-30 to 1e30, to 5e-6 relative: std::sqrt may set errno, which
/// keeps a loop from becoming vector code.
[[gnu::always_inline]] inline float fast_sqrt(float x) {
  // 1/sqrt(x) by halving the exponent, then two steps of Newton's method.
  const float half = 0.5f * x;
  float r = std::bit_cast<float>(0x5f3759dfu - (std::bit_cast<std::uint32_t>(x) >> 1));
  r = r * (1.5f - half * r * r);
  r = r * (1.5f - half * r * r);
  return x * r;
}

struct NormalPair {
  float first, second;
};

/// Two independent standard normal deviates of 64 random bits (Box-Muller), up to 6.66; each
/// to 5e-6 relative or 3e-4 absolute.
[[gnu::always_inline]] inline NormalPair fast_normal_pair(std::uint32_t high, std::uint32_t low) {
  // 31 bits for the radius, centred in their steps, so that the logarithm stays finite. A float
  // keeps 24 of them; near 1 the rest would count: 3e-8 of all draws become 1 and have no radius.
  const float u = (static_cast<float>(static_cast<std::int32_t>(high >> 1)) + 0.5f) * 0x1p-31f;
  const float radius = fast_sqrt(-2.0f * fast_log<Apart>(u));
  // 30 bits for an angle in [-pi/4, pi/4) and two for the quarter of the circle.
  const float a = static_cast<float>(static_cast<std::int32_t>(low << 2)) * 3.6572951e-10f;
  const float z = a * a;
  // Taylor's series, whose next terms are below 4e-7.
  const float sine = a + a * z * (-1.0f / 6 + z * (1.0f / 120 + z * (-1.0f / 5040)));
  const float cosine =
      1.0f + z * (-0.5f + z * (1.0f / 24 + z * (-1.0f / 720 + z * (1.0f / 40320))));
  const bool swap = (low & 0x40000000u) != 0;
  const float turned =
      std::bit_cast<float>(std::bit_cast<std::uint32_t>(cosine) | (low & 0x80000000u));
  return {radius * select(swap, sine, turned), radius * select(swap, turned, sine)};
}

/// 1 - exp(-a) for a in [0, 80], to 2e-7 relative also where a is tiny.
[[gnu::always_inline]] inline float fast_one_minus_exp(float a) {
  // -a = n ln 2 + r with |r| <= ln 2 / 2; the sum with 1.5 * 2^23 rounds to whole n.
  constexpr float kRound = 12582912.0f;
  const float shifted = a * -1.44269504f + kRound;
  const float n = shifted - kRound;
  const float r = (-a - n * 0.693359375f) - n * -2.12194440e-4f;
  // exp(r) - 1 (Cephes, expf.c), in pairs.
  const float r2 = r * r;
  const float low = 1.6666665459e-1f * r + 5.0000001201e-1f;
  const float middle = 8.3334519073e-3f * r + 4.1665795894e-2f;
  const float high = 1.9875691500e-4f * r + 1.3981999507e-3f;
  const float p = low + (middle + high * r2) * r2;
  const float growth = r2 * p + r;
  const std::uint32_t whole = std::bit_cast<std::uint32_t>(shifted) << 23;
  const float power = std::bit_cast<float>(whole + 0x3f800000u);  // 2^n
  return (1.0f - power) - power * growth;
}

/// (1 - exp(-a))/a for a in [0, 1], to 2e-7 relative.
[[gnu::always_inline]] inline float fast_mean_exp(float a) {
  // Interpolated at six Chebyshev nodes (off by 7e-8), in pairs.
  constexpr Fused fma;
  const float a2 = a * a;
  const float low = fma(a, -4.9999515994e-1f, 9.9999993290e-1f);
  const float middle = fma(a, -4.1418763025e-2f, 1.6660967122e-1f);
  const float high = fma(a, -9.1254539173e-4f, 7.8373638017e-3f);
  return fma(fma(high, a2, middle), a2, low);
}

/// The mean of two numbers less their logarithmic mean, for the difference of the numbers and
/// `d`, in [-1, 1], that of their natural logarithms; to 4e-6 of the mean.
[[gnu::always_inline]] inline float log_mean_deficit(float difference, float d) {
  // (a + b)/2 - (b - a)/d = (b - a) (coth(d/2)/2 - 1/d); what is d/12 - d^3/720 + ... comes as
  // d times a polynomial in d^2, interpolated at two Chebyshev nodes.
  return (difference * d) * Fused()(d * d, -1.3565281592e-3f, 8.3329300840e-2f);
}

/// exp(-a) for a >= -700, to 1e-14 relative up to 700 and as there beyond.
[[gnu::always_inline]] inline double fast_exp_minus(double a) {
  const double x = -select(a < 700.0, a, 700.0);
  // x = n ln 2 + r as above, with 1.5 * 2^52.
  constexpr double kRound = 6755399441055744.0;
  const double shifted = x * 1.4426950408889634 + kRound;
  const double n = shifted - kRound;
  const double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  // Taylor's series up to r^11, whose next term is below 7e-15.
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double p0 = (1.0 + r) + r2 * (1.0 / 2 + r * (1.0 / 6));
  const double p4 = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
  const double p8 =
      (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
  const std::uint64_t whole = std::bit_cast<std::uint64_t>(shifted) << 52;
  const double power = std::bit_cast<double>(whole + 0x3ff0000000000000u);  // 2^n
  return power * (p0 + r4 * (p4 + r4 * p8));
}

}  // namespace nightjar::sim
