#include "esi/leaky_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/instruction_sets.h"
#include "esi/leaky_sum_avx512.h"
#include "esi/leaky_sum_blocks.h"
#include "esi/leaky_sum_event.h"

namespace nightjar::esi {
namespace {

/// Smaller k (30 years to nothing) count as 0: no product below comes near a denormal,
/// which would cost a factor of 2 to 5.
constexpr double kLeastRate_hz = 1e-9;

constexpr std::uint32_t kMostAge_us = std::numeric_limits<std::int32_t>::max();

[[gnu::always_inline]] inline std::uint8_t gray_level(float sum, float least, float scale) {
  return static_cast<std::uint8_t>(static_cast<std::int32_t>((sum - least) * scale + 0.5f));
}

[[gnu::always_inline]] inline void draw_kept(const LeakySum& c, const SumCell* cells,
                                             std::size_t count, std::uint8_t* gray) {
  const float least = c.least;
  const float scale = 255.0f / (c.greatest - c.least);
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) gray[i] = gray_level(cells[i].sum, least, scale);
}

template <Leak kLeak>
[[gnu::always_inline]] inline void draw_leaked(const LeakySum& constants, std::uint32_t now_us,
                                               const SumCell* cells, std::size_t count,
                                               std::uint8_t* gray) {
  const LeakySum c = constants;
  const float scale = 255.0f / (c.greatest - c.least);
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t age_us = now_us - cells[i].t_us;
    const std::uint32_t beyond = 0u - (age_us >> 31);
    const float lost = loss<kLeak>(c, (age_us | beyond) & kMostAge_us);
    gray[i] = gray_level(leaked<kLeak>(cells[i].sum, lost), c.least, scale);
  }
}

[[gnu::always_inline]] inline void draw_body(const LeakySum& c, bool leak, std::uint32_t now_us,
                                             std::span<const SumCell> cells, std::uint8_t* gray) {
  const SumCell* data = cells.data();
  const std::size_t count = cells.size();
  if (!leak) return draw_kept(c, data, count, gray);
  switch (c.leak) {
    case Leak::linear: return draw_leaked<Leak::linear>(c, now_us, data, count, gray);
    case Leak::power: return draw_leaked<Leak::power>(c, now_us, data, count, gray);
    case Leak::smooth_power: return draw_leaked<Leak::smooth_power>(c, now_us, data, count, gray);
    case Leak::exponential: return draw_leaked<Leak::exponential>(c, now_us, data, count, gray);
    case Leak::slope: return draw_leaked<Leak::slope>(c, now_us, data, count, gray);
  }
}

void integrate_plain(const LeakySum& c, EventRun& events, SumCell* cells) {
  integrate_blocks(c, events, cells);
}
void draw_plain(const LeakySum& c, bool leak, std::uint32_t now_us, std::span<const SumCell> cells,
                std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void integrate_avx2(const LeakySum& c, EventRun& events, SumCell* cells) {
  integrate_blocks(c, events, cells);
}
[[gnu::target("avx2")]] void draw_avx2(const LeakySum& c, bool leak, std::uint32_t now_us,
                                       std::span<const SumCell> cells, std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]] void draw_avx512(
    const LeakySum& c, bool leak, std::uint32_t now_us, std::span<const SumCell> cells,
    std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}
#endif

double usable_rate_hz(double rate_hz) { return rate_hz < kLeastRate_hz ? 0.0 : rate_hz; }

Leak usable_leak(Leak leak, double rate_hz, double power) {
  if (leak != Leak::power) return leak;
  if (power == 1 || rate_hz == 0) return Leak::linear;
  return power < 1 ? Leak::power : Leak::smooth_power;
}

/// The k dt at which nothing is left, or as good as nothing.
double gone_at(Leak leak, double power) {
  return leak == Leak::smooth_power && power > 8 ? 8 / power : 1;
}

/// 1e-6 `rate_hz`, by no more than rounding too great to give 1 from 1/`rate_hz` on.
float rounded_per_us(double rate_hz) {
  const double gone_us = std::ceil(1e6 / rate_hz);
  auto rate_per_us = static_cast<float>(1e-6 * rate_hz);
  while (gone_us <= kMostAge_us && static_cast<float>(gone_us) * rate_per_us < 1)
    rate_per_us = std::nextafter(rate_per_us, 1.0f);
  return rate_per_us;
}

using PowerTerms = decltype(LeakySum::power_terms);

/// (1 - (1 - unit u)^power)/u in powers of u, interpolated at the Chebyshev nodes of
/// [0, greatest].
template <int kTerms>
PowerTerms interpolated_terms(double greatest, double unit, double power) {
  std::array<double, kTerms> node, term;  // of Newton's form
  for (int i = 0; i < kTerms; ++i) {
    node[i] = 0.5 * greatest * (1 + std::cos(std::numbers::pi * (i + 0.5) / kTerms));
    term[i] = -std::expm1(power * std::log1p(-unit * node[i])) / node[i];
  }
  for (int order = 1; order < kTerms; ++order)  // divided differences
    for (int i = kTerms - 1; i >= order; --i)
      term[i] = (term[i] - term[i - 1]) / (node[i] - node[i - order]);
  for (int order = kTerms - 2; order >= 0; --order)  // multiplied out, innermost first
    for (int i = order; i < kTerms - 1; ++i) term[i] -= node[order] * term[i + 1];
  PowerTerms rounded{};
  std::ranges::transform(term, rounded.begin(), [](double x) { return static_cast<float>(x); });
  return rounded;
}

PowerTerms power_terms_of(Leak leak, double power) {
  if (leak == Leak::smooth_power) return interpolated_terms<8>(1, gone_at(leak, power), power);
  if (leak == Leak::power) return interpolated_terms<5>(0.5, 1, power);
  return {};
}

}  // namespace

LeakySum::LeakySum(Leak leak_, double rate_hz, double power)
    : leak(usable_leak(leak_, usable_rate_hz(rate_hz), power)),
      rate_per_us(rounded_per_us(usable_rate_hz(rate_hz) / gone_at(leak, power))),
      power_terms(power_terms_of(leak, power)) {
  for (std::size_t i = 0; i < octave_factors.size(); ++i)
    octave_factors[i] = static_cast<float>(std::exp2(-power * static_cast<double>(1 << i)));
  constexpr std::uint32_t kHalf = 126;  // the exponent of 1/2; 1 - k dt is 2^-24 or more, or 0
  for (std::uint32_t i = 0; i < 24; ++i) octaves[(kHalf - i) % 32] = octave_power(*this, i);
  octaves[(kHalf + 1) % 32] = 1;
}

std::vector<LeakySumVariant> leaky_sum_variants() {
  std::vector<LeakySumVariant> variants{{"plain", integrate_plain, draw_plain}};
#if defined(__x86_64__)
  const core::InstructionSets sets = core::instruction_sets();
  if (sets.avx2) variants.push_back({"avx2", integrate_avx2, draw_avx2});
  if (sets.avx512) variants.push_back({"avx512", integrate_avx512, draw_avx512});
#endif
  return variants;
}

const LeakySumVariant& best_leaky_sum_variant() {
  static const LeakySumVariant variant = leaky_sum_variants().back();
  return variant;
}

}  // namespace nightjar::esi
