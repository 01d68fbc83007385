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

/// Of each sum, what is left at an event. max_ps(a, b) is a > b ? a : b, as min_ps below is
/// a < b ? a : b: for the bits the order matters.
[[NIGHTJAR_AVX2, gnu::always_inline]] inline __m256 share_left(const MemoryCell& cell,
                                                               __m256i now_us) {
  const __m256i then_us = _mm256_set1_epi32(static_cast<int>(cell.t_us));
  const __m256 age_us = _mm256_cvtepi32_ps(_mm256_sub_epi32(now_us, then_us));
  const __m256 lost = _mm256_mul_ps(_mm256_load_ps(kMemoryConstants.rate_per_us), age_us);
  return _mm256_max_ps(_mm256_sub_ps(_mm256_set1_ps(1.0f), lost), _mm256_setzero_ps());
}

/// The time's bits must not come as far as the multiplication: as a denormal number they would
/// make the event take three times as long.
[[NIGHTJAR_AVX2]] inline void take_avx2(const PackedEvent& e, MemoryCell* cells) {
  const MemoryConstants& c = kMemoryConstants;
  const MemoryConstants::Step& step = c.step[e.on()];
  MemoryCell& cell = cells[e.pixel()];
  float* lanes = reinterpret_cast<float*>(&cell);
  const __m256i now_us = _mm256_set1_epi32(static_cast<int>(e.t_us));
  const __m256 left = share_left(cell, now_us);
  __m256 sum = _mm256_blend_ps(_mm256_load_ps(lanes), _mm256_setzero_ps(), kTime);
  sum = _mm256_mul_ps(_mm256_add_ps(sum, _mm256_load_ps(step.before)), left);
  sum = _mm256_add_ps(sum, _mm256_load_ps(step.after));
  sum = _mm256_max_ps(sum, _mm256_load_ps(c.least));
  sum = _mm256_min_ps(sum, _mm256_load_ps(c.most));
  _mm256_store_ps(lanes, _mm256_blend_ps(sum, _mm256_castsi256_ps(now_us), kTime));
}

/// The same. Masks cost nothing: the first step on the sums leaves the time out, and the last
/// puts the new one in.
[[NIGHTJAR_AVX512]] inline void take_avx512(const PackedEvent& e, MemoryCell* cells) {
  const MemoryConstants& c = kMemoryConstants;
  const MemoryConstants::Step& step = c.step[e.on()];
  MemoryCell& cell = cells[e.pixel()];
  float* lanes = reinterpret_cast<float*>(&cell);
  const __m256i now_us = _mm256_set1_epi32(static_cast<int>(e.t_us));
  const __m256 left = share_left(cell, now_us);
  __m256 sum = _mm256_maskz_add_ps(kSums, _mm256_load_ps(step.before), _mm256_load_ps(lanes));
  sum = _mm256_add_ps(_mm256_mul_ps(sum, left), _mm256_load_ps(step.after));
  sum = _mm256_max_ps(sum, _mm256_load_ps(c.least));
  const __m256 most = _mm256_load_ps(c.most);
  _mm256_store_ps(lanes, _mm256_mask_min_ps(_mm256_castsi256_ps(now_us), kSums, sum, most));
}

}  // namespace

[[NIGHTJAR_AVX2]] void integrate_avx2(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx2>(events, cells);
}

[[NIGHTJAR_AVX512]] void integrate_avx512(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx512>(events, cells);
}

}  // namespace nightjar::esi

#endif
