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

}  // namespace

[[NIGHTJAR_AVX2]] void integrate_avx2(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx2>(events, cells);
}

[[NIGHTJAR_AVX512]] void integrate_avx512(EventRun& events, MemoryCell* cells) {
  integrate_blocks<take_avx512>(events, cells);
}

}  // namespace nightjar::esi

#endif
