#include "esi/memory_cell_x86.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include "esi/memory_cell_blocks.h"
#include "esi/memory_cell_constants.h"

// Of the plain variant's code compilers make comparisons and selections where there are
// instructions for the greater and the less, and have the times pass through general registers.

#define NIGHTJAR_AVX2 gnu::target("avx2")
#define NIGHTJAR_AVX512 gnu::target("avx512f,avx512bw,avx512dq,avx512vl")

namespace nightjar::esi {
namespace {

constexpr int kTime = 1 << kTimeLane;
constexpr int kSums = kTime - 1;

/// For instructions with a mask: without one, gcc 12 warns of its own header.
constexpr __mmask16 kAll = 0xffff;

/// An event at its cell.
struct Visit {
  const MemoryConstants::Step& step;  ///< What it adds.
  float* lanes;                       ///< The cell.
  __m256i now_us;                     ///< In all lanes.
  __m256 left;                        ///< Of each sum.
};

/// max_ps(a, b) is a > b ? a : b, as min_ps below is a < b ? a : b: for the bits the order matters.
[[NIGHTJAR_AVX2, gnu::always_inline]] inline Visit visit(const PackedEvent& e, MemoryCell* cells) {
  MemoryCell& cell = cells[e.pixel()];
  const __m256i now_us = _mm256_set1_epi32(static_cast<int>(e.t_us));
  const __m256i then_us = _mm256_set1_epi32(static_cast<int>(cell.t_us));
  const __m256 age_us = _mm256_cvtepi32_ps(_mm256_sub_epi32(now_us, then_us));
  const __m256 lost = _mm256_mul_ps(_mm256_load_ps(kMemoryConstants.rate_per_us), age_us);
  return {kMemoryConstants.step[e.on()], reinterpret_cast<float*>(&cell), now_us,
          _mm256_max_ps(_mm256_sub_ps(_mm256_set1_ps(1.0f), lost), _mm256_setzero_ps())};
}

/// The time's bits must not come as far as the multiplication: as a denormal number they would
/// make the event take three times as long.
[[NIGHTJAR_AVX2]] inline void take_avx2(const PackedEvent& e, MemoryCell* cells) {
  const Visit at = visit(e, cells);
  __m256 sum = _mm256_blend_ps(_mm256_load_ps(at.lanes), _mm256_setzero_ps(), kTime);
  sum = _mm256_mul_ps(_mm256_add_ps(sum, _mm256_load_ps(at.step.before)), at.left);
  sum = _mm256_add_ps(sum, _mm256_load_ps(at.step.after));
  sum = _mm256_max_ps(sum, _mm256_load_ps(kMemoryConstants.least));
  sum = _mm256_min_ps(sum, _mm256_load_ps(kMemoryConstants.most));
  _mm256_store_ps(at.lanes, _mm256_blend_ps(sum, _mm256_castsi256_ps(at.now_us), kTime));
}

/// The same. Masks cost nothing: the first step on the sums leaves the time out, and the last
/// puts the new one in.
[[NIGHTJAR_AVX512]] inline void take_avx512(const PackedEvent& e, MemoryCell* cells) {
  const Visit at = visit(e, cells);
  __m256 sum = _mm256_maskz_add_ps(kSums, _mm256_load_ps(at.step.before), _mm256_load_ps(at.lanes));
  sum = _mm256_add_ps(_mm256_mul_ps(sum, at.left), _mm256_load_ps(at.step.after));
  sum = _mm256_max_ps(sum, _mm256_load_ps(kMemoryConstants.least));
  const __m256 most = _mm256_load_ps(kMemoryConstants.most);
  const __m256 now = _mm256_castsi256_ps(at.now_us);
  _mm256_store_ps(at.lanes, _mm256_mask_min_ps(now, kSums, sum, most));
}

/// A constant of each lane, for two cells.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline __m512 twice(const float* lanes) {
  const __m512 once = _mm512_castps256_ps512(_mm256_load_ps(lanes));
  return _mm512_maskz_shuffle_f32x4(kAll, once, once, 0b01'00'01'00);
}

/// The features of two cells side by side, as the plain variant has them.
[[NIGHTJAR_AVX512, gnu::always_inline]] inline __m256i two_features(const MemoryCell* cells,
                                                                    std::uint32_t now_us) {
  constexpr __mmask16 kTwoSums = kSums | kSums << kMemoryLanes;
  const MemoryConstants& c = kMemoryConstants;
  const __m512i lanes = _mm512_loadu_si512(cells);
  const __m512i time_lanes =
      _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(_mm256_set1_epi32(kTimeLane)),
                               _mm256_set1_epi32(kMemoryLanes + kTimeLane), 1);
  const __m512i times = _mm512_maskz_permutexvar_epi32(kAll, time_lanes, lanes);
  __m512i age_us = _mm512_sub_epi32(_mm512_set1_epi32(static_cast<int>(now_us)), times);
  age_us = _mm512_maskz_min_epu32(kAll, age_us, _mm512_set1_epi32(0x7fffffff));
  const __m512 one = _mm512_set1_ps(1.0f), age = _mm512_maskz_cvtepi32_ps(kAll, age_us);
  __m512 left = _mm512_sub_ps(one, _mm512_mul_ps(twice(c.rate_per_us), age));
  left = _mm512_maskz_max_ps(kAll, left, twice(c.stays));
  const __m512 sum = _mm512_maskz_mul_ps(kTwoSums, _mm512_castsi512_ps(lanes), left);
  const __m512 size = _mm512_mask_abs_ps(age, kTwoSums, sum);
  const __m512 over = _mm512_mask_mov_ps(one, kTwoSums, sum);
  const __m512 value = _mm512_div_ps(_mm512_mul_ps(twice(c.scale), over),
                                     _mm512_add_ps(one, _mm512_mul_ps(twice(c.squeeze), size)));
  const __m512 lifted = _mm512_add_ps(_mm512_mul_ps(value, _mm512_set1_ps(kFeatureOne)),
                                      _mm512_set1_ps(kFeatureLift + 0.5f));
  const __m512i whole =
      _mm512_sub_epi32(_mm512_maskz_cvttps_epi32(kAll, lifted), _mm512_set1_epi32(kFeatureLift));
  return _mm512_maskz_cvtepi32_epi16(kAll, whole);
}

[[NIGHTJAR_AVX512, gnu::always_inline]] inline void put(__m256i features, std::int16_t* to) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), features);
}

}  // namespace

[[NIGHTJAR_AVX512]] void features_avx512(const MemoryCell* cells, int width, std::uint32_t now_us,
                                         std::int16_t* to) {
  int x = 0;
  for (; x + 2 <= width; x += 2, to += 4 * kPixelFeatures) put(two_features(cells + x, now_us), to);
  if (x == width) return;
  const MemoryCell last[2] = {cells[x], cells[x]};
  put(two_features(last, now_us), to);
}

[[NIGHTJAR_AVX2]] void integrate_avx2(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx2>(events, cells);
}

[[NIGHTJAR_AVX512]] void integrate_avx512(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx512>(events, cells);
}

}  // namespace nightjar::esi

#endif
