#include "esi/leaky_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/instruction_sets.h"
#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

/// Events whose losses are worked out at once: the cells they touch stay in the first
/// cache, and there is enough to fill vectors.
constexpr std::size_t kBlock = 64;

/// Smaller k (30 years to nothing) count as 0: no product below comes near a denormal,
/// which would cost a factor of 2 to 5.
constexpr double kLeastRate_hz = 1e-9;

constexpr std::uint32_t kMostAge_us = std::numeric_limits<std::int32_t>::max();

// log(1 + f)/f for f in [sqrt(1/2) - 1, sqrt(2) - 1] to 7.4e-6, relative: minimax in
// powers of f.
constexpr std::array<double, 6> kLog = {1.000004529953003,   -0.4999021887779236,
                                        0.33258023858070374, -0.254032701253891,
                                        0.22055937349796295, -0.14292074739933014};

// (2^r - 1)/r for |r| <= 1/2 to 1.5e-5, relative.
constexpr std::array<float, 4> kExp2 = {0.69313686f, 0.24023252f, 0.05583729f, 0.00961811f};

/// k dt.
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
  const float growth = r * ((kExp2[0] + kExp2[1] * r) + r * r * (kExp2[2] + kExp2[3] * r));
  const std::uint32_t whole = (std::bit_cast<std::uint32_t>(shifted) << 23) + 0x3f800000u;
  const float power = std::bit_cast<float>(whole);  // 2^n
  return (1.0f - power) - power * growth;
}

/// 1 - max(1 - k dt, 0)^b, the power as 2^(b log2(1 - k dt)).
[[gnu::always_inline]] inline float power_loss(const LeakySum& c, std::uint32_t age_us) {
  const float u = spent(c, age_us);
  constexpr float kLeastLeft = 0x1p-24f;  // 1 - u may have been rounded to 0
  const float left = select(1.0f - u > kLeastLeft, 1.0f - u, kLeastLeft);
  // left = 2^e (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)); f = -u exactly where e = 0.
  constexpr std::uint32_t kSqrtHalf = 0x3f3504f3;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(left) - kSqrtHalf;
  const std::int32_t exponent = static_cast<std::int32_t>(bits) >> 23;
  const float mantissa = std::bit_cast<float>((bits & 0x007fffffu) + kSqrtHalf);
  const float f = select(exponent == 0, -u, mantissa - 1.0f);
  const float f2 = f * f;
  const auto& a = c.log_terms;
  const float log = f * ((a[0] + a[1] * f) + f2 * ((a[2] + a[3] * f) + f2 * (a[4] + a[5] * f)));
  const float lost = exp2_loss(static_cast<float>(exponent) * c.power + log);
  return select(age_us >= c.gone_us, 1.0f, lost);
}

/// u (1 - (1 - u)^p)/u by its polynomial.
[[gnu::always_inline]] inline float smooth_loss(const LeakySum& c, float u) {
  const float u2 = u * u;
  const auto& a = c.power_terms;  // in pairs: a shorter chain than Horner's
  const float high = (a[4] + a[5] * u) + u2 * (a[6] + a[7] * u);
  return u * ((a[0] + a[1] * u) + u2 * ((a[2] + a[3] * u) + u2 * high));
}

/// The same where the power is smooth up to its end.
[[gnu::always_inline]] inline float smooth_power_loss(const LeakySum& c, std::uint32_t age_us) {
  return select(age_us >= c.gone_us, 1.0f, smooth_loss(c, spent(c, age_us)));
}

/// The same where the power of the root is.
[[gnu::always_inline]] inline float root_power_loss(const LeakySum& c, std::uint32_t age_us) {
  const float u = spent(c, age_us);
  const float left = select(u < 1.0f, 1.0f - u, 0.0f);
  const float root_loss = u / (1.0f + std::sqrt(left));  // 1 - sqrt(1 - u), fine near 0, too
  return select(age_us >= c.gone_us, 1.0f, smooth_loss(c, root_loss));
}

/// What is lost of a sum: a share, but an amount for Leak::slope.
template <Leak kLeak>
[[gnu::always_inline]] inline float loss(const LeakySum& c, std::uint32_t age_us) {
  if constexpr (kLeak == Leak::power) return power_loss(c, age_us);
  if constexpr (kLeak == Leak::smooth_power) return smooth_power_loss(c, age_us);
  if constexpr (kLeak == Leak::root_power) return root_power_loss(c, age_us);
  const float u = spent(c, age_us);
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
  for (std::size_t i = 0; i < count; ++i) lost[i] = loss<kLeak>(c, age_us[i]);
}

/// A pixel's ages depend on nothing but its events' times, so the losses of a whole block
/// are worked out in vectors, after a walk over the times and before one over the sums. The
/// latter goes along with the next block's first: the two have nothing to wait for from
/// each other.
template <Leak kLeak, bool kLeakFirst>
[[gnu::always_inline]] inline void take_blocks(const LeakySum& constants, EventRun& events,
                                               SumCell* cells) {
  const LeakySum c = constants;  // copies: the stores below cannot change them
  EventRun run = events;
  alignas(64) std::uint32_t age_us[kBlock];
  alignas(64) float lost[kBlock];
  auto block = run.next(kBlock);
  for (std::size_t i = 0; i < block.size(); ++i) age_us[i] = take_age(block[i], cells);
  while (!block.empty()) {
    work_out<kLeak>(c, age_us, block.size(), lost);
    const auto next = run.next(kBlock);  // no longer than `block`
    for (std::size_t i = 0; i < next.size(); ++i) {
      age_us[i] = take_age(next[i], cells);
      add_event<kLeak, kLeakFirst>(c, block[i].on(), lost[i], cells[block[i].pixel()].sum);
    }
    for (std::size_t i = next.size(); i < block.size(); ++i)
      add_event<kLeak, kLeakFirst>(c, block[i].on(), lost[i], cells[block[i].pixel()].sum);
    block = next;
  }
  events = run;
}

template <bool kLeakFirst>
[[gnu::always_inline]] inline void integrate_body(const LeakySum& c, EventRun& events,
                                                  SumCell* cells) {
  switch (c.leak) {
    case Leak::linear: return take_blocks<Leak::linear, kLeakFirst>(c, events, cells);
    case Leak::power: return take_blocks<Leak::power, kLeakFirst>(c, events, cells);
    case Leak::smooth_power: return take_blocks<Leak::smooth_power, kLeakFirst>(c, events, cells);
    case Leak::root_power: return take_blocks<Leak::root_power, kLeakFirst>(c, events, cells);
    case Leak::exponential: return take_blocks<Leak::exponential, kLeakFirst>(c, events, cells);
    case Leak::slope: return take_blocks<Leak::slope, kLeakFirst>(c, events, cells);
  }
}

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
    case Leak::root_power: return draw_leaked<Leak::root_power>(c, now_us, data, count, gray);
    case Leak::exponential: return draw_leaked<Leak::exponential>(c, now_us, data, count, gray);
    case Leak::slope: return draw_leaked<Leak::slope>(c, now_us, data, count, gray);
  }
}

void integrate_plain(const LeakySum& c, EventRun& events, SumCell* cells) {
  c.leak_first ? integrate_body<true>(c, events, cells) : integrate_body<false>(c, events, cells);
}
void draw_plain(const LeakySum& c, bool leak, std::uint32_t now_us, std::span<const SumCell> cells,
                std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void integrate_avx2(const LeakySum& c, EventRun& events, SumCell* cells) {
  c.leak_first ? integrate_body<true>(c, events, cells) : integrate_body<false>(c, events, cells);
}
[[gnu::target("avx2")]] void draw_avx2(const LeakySum& c, bool leak, std::uint32_t now_us,
                                       std::span<const SumCell> cells, std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]] void integrate_avx512(
    const LeakySum& c, EventRun& events, SumCell* cells) {
  c.leak_first ? integrate_body<true>(c, events, cells) : integrate_body<false>(c, events, cells);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]] void draw_avx512(
    const LeakySum& c, bool leak, std::uint32_t now_us, std::span<const SumCell> cells,
    std::uint8_t* gray) {
  draw_body(c, leak, now_us, cells, gray);
}
#endif

std::uint32_t first_age_gone(double rate_hz) {
  const double us = std::ceil(1e6 / rate_hz);
  return us > kMostAge_us ? std::numeric_limits<std::uint32_t>::max()
                          : static_cast<std::uint32_t>(us);
}

double usable_rate_hz(double rate_hz) { return rate_hz < kLeastRate_hz ? 0.0 : rate_hz; }

Leak usable_leak(Leak leak, double power) {
  if (leak != Leak::power || power < 0.5 || power > 8) return leak;
  if (power == 1) return Leak::linear;
  return power < 1 ? Leak::root_power : Leak::smooth_power;
}

/// (1 - (1 - u)^power)/u in powers of u, interpolated at the Chebyshev nodes of [0, 1].
std::array<float, 8> smooth_power_terms(double power) {
  constexpr int kTerms = 8;
  std::array<double, kTerms> node, term;  // of Newton's form
  for (int i = 0; i < kTerms; ++i) {
    node[i] = 0.5 + 0.5 * std::cos(std::numbers::pi * (i + 0.5) / kTerms);
    term[i] = -std::expm1(power * std::log1p(-node[i])) / node[i];
  }
  for (int order = 1; order < kTerms; ++order)  // divided differences
    for (int i = kTerms - 1; i >= order; --i)
      term[i] = (term[i] - term[i - 1]) / (node[i] - node[i - order]);
  for (int order = kTerms - 2; order >= 0; --order)  // multiplied out, innermost first
    for (int i = order; i < kTerms - 1; ++i) term[i] -= node[order] * term[i + 1];
  std::array<float, kTerms> rounded;
  std::ranges::transform(term, rounded.begin(), [](double x) { return static_cast<float>(x); });
  return rounded;
}

}  // namespace

LeakySum::LeakySum(Leak leak_, double rate_hz, double power_)
    : leak(usable_leak(leak_, power_)),
      rate_per_us(static_cast<float>(1e-6 * usable_rate_hz(rate_hz))),
      gone_us(first_age_gone(usable_rate_hz(rate_hz))),
      power(static_cast<float>(power_)) {
  if (leak == Leak::power)
    for (std::size_t i = 0; i < kLog.size(); ++i)
      log_terms[i] = static_cast<float>(kLog[i] * power_ / std::numbers::ln2);
  if (leak == Leak::smooth_power) power_terms = smooth_power_terms(power_);
  if (leak == Leak::root_power) power_terms = smooth_power_terms(2 * power_);
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
