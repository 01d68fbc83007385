#include "esi/leaky_sum_avx512.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <cstring>

#include "esi/leaky_sum_blocks.h"
#include "esi/leaky_sum_event.h"

#if defined(__clang__)  // takes the registers that it is given
#define NIGHTJAR_AVX512 gnu::target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl")
#else
#define NIGHTJAR_AVX512 \
  gnu::target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl,prefer-vector-width=512")
#endif

namespace nightjar::esi {
namespace {

/// Events taken at once: 16 floats are a register.
constexpr std::size_t kFew = 16;

// For instructions with a mask: without one, gcc 12 warns of its own header.
constexpr __mmask8 kAll = 0xff;
constexpr __mmask16 kAllFew = 0xffff;

using Floats [[gnu::vector_size(64)]] = float;
using Words [[gnu::vector_size(64)]] = std::uint32_t;
using Integers [[gnu::vector_size(64)]] = std::int32_t;

[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats all_of(float x) { return x - Floats{}; }

/// Eight bytes as they are. Cells move as such: a store that is still on its way can be
/// loaded from only as a whole.
using Bytes [[gnu::may_alias]] = double;

[[NIGHTJAR_AVX512, gnu::always_inline]] inline __m128d two_cells(const PackedEvent* e,
                                                                 const SumCell* cells) {
  const auto* first = reinterpret_cast<const Bytes*>(cells + e[0].pixel());
  const auto* second = reinterpret_cast<const double*>(cells + e[1].pixel());
  return _mm_loadh_pd(_mm_set_sd(*first), second);
}

/// The cells of eight events.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats eight_cells(const PackedEvent* e,
                                                                  const SumCell* cells) {
  const __m256d low = _mm256_set_m128d(two_cells(e + 2, cells), two_cells(e, cells));
  const __m256d high = _mm256_set_m128d(two_cells(e + 6, cells), two_cells(e + 4, cells));
  return reinterpret_cast<Floats>(
      _mm512_maskz_insertf64x4(kAll, _mm512_castpd256_pd512(low), high, 1));
}

[[NIGHTJAR_AVX512, gnu::always_inline]] inline void put_two(__m128d two, const PackedEvent* e,
                                                            SumCell* cells) {
  *reinterpret_cast<Bytes*>(cells + e[0].pixel()) = two[0];
  *reinterpret_cast<Bytes*>(cells + e[1].pixel()) = two[1];
}

[[NIGHTJAR_AVX512, gnu::always_inline]] inline void put_eight(Floats eight, const PackedEvent* e,
                                                              SumCell* cells) {
  const __m512d bytes = reinterpret_cast<__m512d>(eight);
  const __m256d low = _mm512_maskz_extractf64x4_pd(kAll, bytes, 0);
  const __m256d high = _mm512_maskz_extractf64x4_pd(kAll, bytes, 1);
  put_two(_mm256_extractf128_pd(low, 0), e, cells);
  put_two(_mm256_extractf128_pd(low, 1), e + 2, cells);
  put_two(_mm256_extractf128_pd(high, 0), e + 4, cells);
  put_two(_mm256_extractf128_pd(high, 1), e + 6, cells);
}

// Of pairs in two registers, the first or the second of each; and pairs from such. In an order
// that needs no instruction to leave a register's quarter.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats firsts(Floats a, Floats b) {
  return __builtin_shufflevector(a, b, 0, 2, 16, 18, 4, 6, 20, 22, 8, 10, 24, 26, 12, 14, 28, 30);
}
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats seconds(Floats a, Floats b) {
  return __builtin_shufflevector(a, b, 1, 3, 17, 19, 5, 7, 21, 23, 9, 11, 25, 27, 13, 15, 29, 31);
}
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats first_pairs(Floats a, Floats b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats second_pairs(Floats a, Floats b) {
  return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}

/// A LeakySum in registers, each constant in all lanes: of scalars, compilers would make such
/// registers anew for every few events.
struct Constants {
  [[NIGHTJAR_AVX512, gnu::always_inline]] explicit Constants(const LeakySum& c)
      : rate_per_us(all_of(c.rate_per_us)),
        octaves{_mm512_loadu_ps(c.octaves.data()), _mm512_loadu_ps(c.octaves.data() + kFew)},
        step{_mm512_set1_ps(c.step[0]), _mm512_set1_ps(c.step[1])},
        least(all_of(c.least)),
        greatest(all_of(c.greatest)) {
    for (int i = 0; i < 8; ++i) power_terms[i] = all_of(c.power_terms[i]);
  }

  Floats rate_per_us;
  Floats power_terms[8];
  __m512 octaves[2];
  __m512 step[2];
  Floats least, greatest;
};

/// loss_ratio() with the same bits.
template <int kTerms>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats loss_ratios(const Constants& c, Floats u) {
  const Floats u2 = u * u;
  const auto& a = c.power_terms;
  Floats high = a[4];
  if constexpr (kTerms == 8) high = (high + a[5] * u) + u2 * (a[6] + a[7] * u);
  return (a[0] + a[1] * u) + u2 * ((a[2] + a[3] * u) + u2 * high);
}

/// power_loss() with the same bits, and for u = 1 all.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats power_losses(const Constants& c, Floats u) {
  const Floats left = 1.0f - u;
  const auto exponent = reinterpret_cast<__m512i>(reinterpret_cast<Words>(left) >> 23);
  const auto power =
      reinterpret_cast<Floats>(_mm512_permutex2var_ps(c.octaves[0], exponent, c.octaves[1]));
  const auto mantissa = reinterpret_cast<Floats>(_mm512_maskz_getmant_ps(
      kAllFew, reinterpret_cast<__m512>(left), _MM_MANT_NORM_p5_1, _MM_MANT_SIGN_src));
  const Floats v = u <= 0.5f ? u : 1.0f - mantissa;
  return (1.0f - power) + (power * v) * loss_ratios<5>(c, v);
}

/// exp2_loss() of each.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats exp2_losses(Floats x) {
  alignas(64) float each[kFew];
  std::memcpy(each, &x, sizeof(each));
#pragma GCC unroll 1  // is to become vectors
  for (float& value : each) value = exp2_loss(value);
  std::memcpy(&x, each, sizeof(x));
  return x;
}

/// loss() for sixteen ages.
template <Leak kLeak>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats losses(const Constants& c, Words age_us) {
  const Floats u =
      __builtin_convertvector(reinterpret_cast<Integers>(age_us), Floats) * c.rate_per_us;
  if constexpr (kLeak == Leak::slope) return u;
  if constexpr (kLeak == Leak::exponential) return exp2_losses(-u);
  if constexpr (kLeak == Leak::smooth_power)
    return u < 1.0f ? u * loss_ratios<8>(c, u) : all_of(1.0f);
  const auto at_most_1 = reinterpret_cast<Floats>(
      _mm512_maskz_min_ps(kAllFew, reinterpret_cast<__m512>(u), _mm512_set1_ps(1.0f)));
  return kLeak == Leak::power ? power_losses(c, at_most_1) : at_most_1;
}

/// add_event() for sixteen different pixels.
template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats added(const Constants& c, Words pixel_on,
                                                            Floats lost, Floats sum) {
  const auto on = _mm512_movepi32_mask(reinterpret_cast<__m512i>(pixel_on << 31));
  const auto step = reinterpret_cast<Floats>(_mm512_mask_blend_ps(on, c.step[0], c.step[1]));
  if constexpr (!kLeakFirst) sum += step;
  if constexpr (kLeak == Leak::slope) {
    const Floats down = sum < lost ? sum : lost;
    sum -= down > -lost ? down : -lost;
  } else {
    sum -= sum * lost;
  }
  if constexpr (kLeakFirst) sum += step;
  sum = sum > c.least ? sum : c.least;
  return sum < c.greatest ? sum : c.greatest;
}

/// Sixteen events.
struct Few {
  [[NIGHTJAR_AVX512, gnu::always_inline]] explicit Few(const PackedEvent* events) {
    Floats low, high;
    std::memcpy(&low, events, sizeof(low));
    std::memcpy(&high, events + kFew / 2, sizeof(high));
    t_us = firsts(low, high);
    pixel_on = seconds(low, high);
  }

  Floats t_us, pixel_on;  ///< Their bits.
};

/// What EventRun::next() sees to, for kFew events before at least one more that is in order,
/// too.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline bool are_plain(const EventRun::Limits& limits,
                                                              const PackedEvent* events,
                                                              const Few& few) {
  const auto t_us = reinterpret_cast<__m512i>(few.t_us);
  const auto next_us = reinterpret_cast<__m512i>(Few(events + 1).t_us);
  const auto pixel_on = reinterpret_cast<__m512i>(few.pixel_on);
  const auto end = _mm512_set1_epi32(static_cast<int>(limits.pixel_on_end));
  const unsigned bad =
      _mm512_cmplt_epu32_mask(next_us, t_us) | _mm512_cmpge_epu32_mask(pixel_on, end);
  return bad == 0 && events[0].t_us >= limits.earliest_us &&
         events[kFew - 1].t_us - limits.begin_us < limits.most_us;
}

/// Events some of which are at the same pixel.
template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::noinline]] void take_in_turn(const LeakySum& c, const PackedEvent* events,
                                                     std::size_t count, SumCell* cells) {
  alignas(64) std::uint32_t age_us[kLeakyBlock];
  alignas(64) float lost[kLeakyBlock];
  for (std::size_t i = 0; i < count; ++i) age_us[i] = take_age(events[i], cells);
  work_out<kLeak>(c, age_us, count, lost);
  for (std::size_t i = 0; i < count; ++i)
    add_event<kLeak, kLeakFirst>(c, events[i].on(), lost[i], cells[events[i].pixel()].sum);
}

template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline void put_few(const Constants& c,
                                                            const PackedEvent* events,
                                                            const Few& few, SumCell* cells) {
  const Words pixel_on = reinterpret_cast<Words>(few.pixel_on);
  const Floats low_cells = eight_cells(events, cells);
  const Floats high_cells = eight_cells(events + kFew / 2, cells);
  const Words age_us =
      reinterpret_cast<Words>(few.t_us) - reinterpret_cast<Words>(seconds(low_cells, high_cells));
  const Floats lost = losses<kLeak>(c, age_us);
  const Floats now = added<kLeak, kLeakFirst>(c, pixel_on, lost, firsts(low_cells, high_cells));
  put_eight(first_pairs(now, few.t_us), events, cells);
  put_eight(second_pairs(now, few.t_us), events + kFew / 2, cells);
}

[[NIGHTJAR_AVX512, gnu::always_inline]] inline bool pixels_differ(const Few& few) {
  const Words pixel = reinterpret_cast<Words>(few.pixel_on) >> 1;
  const auto same = _mm512_conflict_epi32(reinterpret_cast<__m512i>(pixel));
  return _mm512_test_epi32_mask(same, same) == 0;
}

template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline void take_all(const LeakySum& constants,
                                                             EventRun& events, SumCell* cells) {
  const Constants c(constants);
  EventRun run = events;
  while (run.rest().size() > kFew) {
    const PackedEvent* next = run.rest().data();
    const Few few(next);
    if (run.limits() && !are_plain(*run.limits(), next, few)) break;
    run.take(kFew);
    if (pixels_differ(few)) [[likely]]
      put_few<kLeak, kLeakFirst>(c, next, few, cells);
    else
      take_in_turn<kLeak, kLeakFirst>(constants, next, kFew, cells);
  }
  for (auto block = run.next(kLeakyBlock); !block.empty(); block = run.next(kLeakyBlock))
    take_in_turn<kLeak, kLeakFirst>(constants, block.data(), block.size(), cells);
  events = run;
}

template <bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline void integrate(const LeakySum& c, EventRun& events,
                                                              SumCell* cells) {
  switch (c.leak) {
    case Leak::linear: return take_all<Leak::linear, kLeakFirst>(c, events, cells);
    case Leak::power: return take_all<Leak::power, kLeakFirst>(c, events, cells);
    case Leak::smooth_power: return take_all<Leak::smooth_power, kLeakFirst>(c, events, cells);
    case Leak::exponential: return take_all<Leak::exponential, kLeakFirst>(c, events, cells);
    case Leak::slope: return take_all<Leak::slope, kLeakFirst>(c, events, cells);
  }
}

}  // namespace

[[NIGHTJAR_AVX512]] void integrate_avx512(const LeakySum& sum, EventRun& events, SumCell* cells) {
  sum.leak_first ? integrate<true>(sum, events, cells) : integrate<false>(sum, events, cells);
}

}  // namespace nightjar::esi

#endif
