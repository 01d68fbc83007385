#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "esi/fast_math.h"
#include "esi/leaky_sum.h"

/// What an event does to a sum, for the loops over events and pixels to take in: written
/// without branches, so that they become vector code, with the same bits everywhere.
namespace nightjar::esi {

// (2^r - 1)/r for |r| <= 1/2 to 1.5e-5, relative.
inline constexpr std::array<float, 4> kLossExp2 = {0.69313686f, 0.24023252f, 0.05583729f,
                                                   0.00961811f};

/// k dt, of powers the share of the dt after which nothing is left.
[[gnu::always_inline]] inline float spent(const LeakySum& c, std::uint32_t age_us) {
  return static_cast<float>(static_cast<std::int32_t>(age_us)) * c.rate_per_us;
}

/// 1 - 2^x for x <= 0.
[[gnu::always_inline]] inline float exp2_loss(float x) {
  // x = n + r with |r| <= 1/2; the sum with 1.5 * 2^23 rounds to whole n.
  constexpr float kRound = 12582912.0f;
  const float near = select(x > -100.0f, x, -100.0f);
  const float shifted = near + kRound;
  const float r = near - (shifted - kRound);
  const float growth =
      r * ((kLossExp2[0] + kLossExp2[1] * r) + r * r * (kLossExp2[2] + kLossExp2[3] * r));
  const std::uint32_t whole = (std::bit_cast<std::uint32_t>(shifted) << 23) + 0x3f800000u;
  const float power = std::bit_cast<float>(whole);  // 2^n
  return (1.0f - power) - power * growth;
}

/// (1 - (1 - u)^p)/u by its polynomial, of 5 or of 8 terms.
template <int kTerms>
[[gnu::always_inline]] inline float loss_ratio(const LeakySum& c, float u) {
  const float u2 = u * u;
  const auto& a = c.power_terms;  // in pairs: a shorter chain than Horner's
  float high = a[4];
  if constexpr (kTerms == 8) high = (high + a[5] * u) + u2 * (a[6] + a[7] * u);
  return (a[0] + a[1] * u) + u2 * ((a[2] + a[3] * u) + u2 * high);
}

/// 2^(-b octave), without a table: a vector of lookups is slow.
[[gnu::always_inline]] inline float octave_power(const LeakySum& c, std::uint32_t octave) {
  const auto& f = c.octave_factors;
  const float low = select((octave & 1u) != 0, f[0], 1.0f) * select((octave & 2u) != 0, f[1], 1.0f);
  const float high =
      select((octave & 4u) != 0, f[2], 1.0f) * select((octave & 8u) != 0, f[3], 1.0f);
  return low * high * select((octave & 16u) != 0, f[4], 1.0f);
}

/// 1 - (1 - u)^b for b < 1 and u < 1.
[[gnu::always_inline]] inline float power_loss(const LeakySum& c, float u) {
  // 1 - u is 2^-octave (1 - v) with 1 - v in [1/2, 1).
  constexpr float kMostLeft = 0x1.fffffep-1f;  // 1 would have an octave of its own
  const float left = select(1.0f - u < kMostLeft, 1.0f - u, kMostLeft);
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(left);
  const float mantissa = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f000000u);
  const float v = select(u <= 0.5f, u, 1.0f - mantissa);  // u is the finer of the two
  const float power = octave_power(c, 126u - (bits >> 23));
  return (1.0f - power) + (power * v) * loss_ratio<5>(c, v);
}

/// What is lost of a sum: a share, but an amount for Leak::slope.
template <Leak kLeak>
[[gnu::always_inline]] inline float loss(const LeakySum& c, std::uint32_t age_us) {
  const float u = spent(c, age_us);
  if constexpr (kLeak == Leak::power) return select(u < 1.0f, power_loss(c, u), 1.0f);
  if constexpr (kLeak == Leak::smooth_power) return select(u < 1.0f, u * loss_ratio<8>(c, u), 1.0f);
  if constexpr (kLeak == Leak::exponential) return exp2_loss(-u);
  if constexpr (kLeak == Leak::linear) return u < 1.0f ? u : 1.0f;
  return u;
}

template <Leak kLeak>
[[gnu::always_inline]] inline float leaked(float sum, float lost) {
  if constexpr (kLeak != Leak::slope) return sum - sum * lost;
  const float down = sum < lost ? sum : lost;
  return sum - (down > -lost ? down : -lost);
}

template <Leak kLeak, bool kLeakFirst>
[[gnu::always_inline]] inline void add_event(const LeakySum& c, bool on, float lost, float& cell) {
  float sum = cell;
  if constexpr (!kLeakFirst) sum += c.step[on];
  sum = leaked<kLeak>(sum, lost);
  if constexpr (kLeakFirst) sum += c.step[on];
  sum = sum > c.least ? sum : c.least;
  cell = sum < c.greatest ? sum : c.greatest;
}

/// The time since the pixel's last event.
[[gnu::always_inline]] inline std::uint32_t take_age(const PackedEvent& e, SumCell* cells) {
  std::uint32_t& t_us = cells[e.pixel()].t_us;
  const std::uint32_t age_us = e.t_us - t_us;
  t_us = e.t_us;
  return age_us;
}

template <Leak kLeak>
[[gnu::always_inline]] inline void work_out(const LeakySum& c, const std::uint32_t* age_us,
                                            std::size_t count, float* lost) {
#pragma GCC ivdep
#pragma GCC unroll 1  // a short loop, too, is to become vectors
  for (std::size_t i = 0; i < count; ++i) lost[i] = loss<kLeak>(c, age_us[i]);
}

}  // namespace nightjar::esi
