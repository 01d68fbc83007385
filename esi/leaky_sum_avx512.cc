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

/// For instructions with a mask: without one, gcc 12 warns of its own header.
constexpr __mmask8 kAll = 0xff;

using Floats [[gnu::vector_size(64)]] = float;
using Words [[gnu::vector_size(64)]] = std::uint32_t;

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

template <Leak kLeak>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats losses(const LeakySum& c, Words age_us) {
  alignas(64) std::uint32_t age[kFew];
  alignas(64) float lost[kFew];
  std::memcpy(age, &age_us, sizeof(age));
  work_out<kLeak>(c, age, kFew, lost);
  Floats all;
  std::memcpy(&all, lost, sizeof(all));
  return all;
}

/// The same with the octaves in registers, where the compiler would gather from memory.
template <>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats losses<Leak::power>(const LeakySum& c,
                                                                          Words age_us) {
  alignas(64) std::uint32_t age[kFew], octave[kFew];
  alignas(64) float within[kFew];
  std::memcpy(age, &age_us, sizeof(age));
#pragma GCC ivdep
#pragma GCC unroll 1
  for (std::size_t i = 0; i < kFew; ++i) {
    const PowerParts parts = power_parts(c, age[i]);
    octave[i] = parts.octave;
    within[i] = parts.lost;
  }
  Floats lost;
  std::memcpy(&lost, within, sizeof(lost));
  const auto octaves = _mm512_load_si512(octave);
  const auto low = _mm512_loadu_ps(c.octaves.data());
  const auto high = _mm512_loadu_ps(c.octaves.data() + kFew);
  const auto power = reinterpret_cast<Floats>(_mm512_permutex2var_ps(low, octaves, high));
  lost = (1.0f - power) + power * lost;
  return age_us >= c.gone_us ? all_of(1.0f) : lost;
}

/// Whether all is lost wherever these events are, as mostly where k is large: then there is
/// nothing to work out.
template <Leak kLeak>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline bool all_gone(const LeakySum& c, Words age_us) {
  if constexpr (kLeak == Leak::linear || kLeak == Leak::exponential || kLeak == Leak::slope)
    return false;
  const auto gone_us = _mm512_set1_epi32(static_cast<int>(c.gone_us));
  return _mm512_cmplt_epu32_mask(reinterpret_cast<__m512i>(age_us), gone_us) == 0;
}

/// add_event() for sixteen different pixels.
template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline Floats added(const LeakySum& c, Words pixel_on,
                                                            Floats lost, Floats sum) {
  const Floats step = (pixel_on & 1u) != 0 ? all_of(c.step[1]) : all_of(c.step[0]);
  if constexpr (!kLeakFirst) sum += step;
  if constexpr (kLeak == Leak::slope) {
    const Floats down = sum < lost ? sum : lost;
    sum -= down > -lost ? down : -lost;
  } else {
    sum -= sum * lost;
  }
  if constexpr (kLeakFirst) sum += step;
  const Floats least = all_of(c.least), greatest = all_of(c.greatest);
  sum = sum > least ? sum : least;
  return sum < greatest ? sum : greatest;
}

/// What EventRun::next() sees to, for kFew events before at least one more that is in order,
/// too.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline bool are_plain(const EventRun::Limits& limits,
                                                              const PackedEvent* events) {
  Floats low, high, next_low, next_high;
  std::memcpy(&low, events, sizeof(low));
  std::memcpy(&high, events + kFew / 2, sizeof(high));
  std::memcpy(&next_low, events + 1, sizeof(next_low));
  std::memcpy(&next_high, events + 1 + kFew / 2, sizeof(next_high));
  const auto t_us = reinterpret_cast<__m512i>(firsts(low, high));
  const auto next_us = reinterpret_cast<__m512i>(firsts(next_low, next_high));
  const auto pixel_on = reinterpret_cast<__m512i>(seconds(low, high));
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
[[NIGHTJAR_AVX512, gnu::always_inline]] inline void take_few(const LeakySum& c,
                                                             const LeakySum& constants,
                                                             const PackedEvent* events,
                                                             SumCell* cells) {
  Floats low, high;
  std::memcpy(&low, events, sizeof(low));
  std::memcpy(&high, events + kFew / 2, sizeof(high));
  const Words pixel_on = reinterpret_cast<Words>(seconds(low, high));
  const auto same = _mm512_conflict_epi32(reinterpret_cast<__m512i>(pixel_on >> 1));
  if (_mm512_test_epi32_mask(same, same) != 0) [[unlikely]]
    return take_in_turn<kLeak, kLeakFirst>(constants, events, kFew, cells);
  const Floats t_us = firsts(low, high);
  const Floats low_cells = eight_cells(events, cells);
  const Floats high_cells = eight_cells(events + kFew / 2, cells);
  const Words age_us =
      reinterpret_cast<Words>(t_us) - reinterpret_cast<Words>(seconds(low_cells, high_cells));
  const Floats lost = all_gone<kLeak>(c, age_us) ? all_of(1.0f) : losses<kLeak>(c, age_us);
  const Floats sum = added<kLeak, kLeakFirst>(c, pixel_on, lost, firsts(low_cells, high_cells));
  put_eight(first_pairs(sum, t_us), events, cells);
  put_eight(second_pairs(sum, t_us), events + kFew / 2, cells);
}

template <Leak kLeak, bool kLeakFirst>
[[NIGHTJAR_AVX512, gnu::always_inline]] inline void take_all(const LeakySum& constants,
                                                             EventRun& events, SumCell* cells) {
  const LeakySum c = constants;  // copies: the stores below cannot change them
  EventRun run = events;
  while (run.rest().size() > kFew) {
    const PackedEvent* few = run.rest().data();
    if (run.limits() && !are_plain(*run.limits(), few)) break;
    run.take(kFew);
    take_few<kLeak, kLeakFirst>(c, constants, few, cells);
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
    case Leak::steep_power: return take_all<Leak::steep_power, kLeakFirst>(c, events, cells);
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
