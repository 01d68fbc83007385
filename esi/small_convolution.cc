#include "esi/small_convolution.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/instruction_sets.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nightjar::esi {
namespace {

std::int32_t half_of(int shift) { return shift > 0 ? 1 << (shift - 1) : 0; }

void row_plain(const Convolution& c, const ChannelImage& in, int y, ChannelImage& out) {
  for (int x = 0; x < in.width(); ++x) {
    std::int32_t sums[kConvolutionOut];
    std::ranges::copy(c.bias, sums);
    const std::int16_t* weight = c.weights.data();
    for (int row = -1; row <= 1; ++row) {
      const std::int16_t* value = in.at(x - 1, y + row);  // three neighbours lie together
      for (int pair = 0; pair < 3 * c.in / 2; ++pair, value += 2, weight += 2 * kConvolutionOut)
        for (int o = 0; o < kConvolutionOut; ++o)
          sums[o] += weight[2 * o] * value[0] + weight[2 * o + 1] * value[1];
    }
    std::int16_t* to = out.at(x, y);
    for (int o = 0; o < kConvolutionOut; ++o)
      to[o] = static_cast<std::int16_t>(
          std::clamp((sums[o] + half_of(c.shift)) >> c.shift, c.least, kMostValue));
  }
}

#if defined(__x86_64__)

// Below, kPixels neighbours at once, so that each weight is loaded once for all of them; a
// pair of inputs, spread over a register, meets as many outputs as it holds with a single
// multiplication. Sums, a weight and a value fill the registers that there are.

int pair_at(const std::int16_t* value) {
  int two;
  std::memcpy(&two, value, sizeof(two));
  return two;
}

template <int kPixels>
void pixels_sse2(const Convolution& c, const ChannelImage& in, int x, int y, ChannelImage& out) {
  __m128i sums[kPixels][4];
  for (auto& sum : sums)
    for (int i = 0; i < 4; ++i)
      sum[i] = _mm_loadu_si128(reinterpret_cast<const __m128i*>(c.bias.data()) + i);
  const auto* weight = reinterpret_cast<const __m128i*>(c.weights.data());
  for (int row = -1; row <= 1; ++row) {
    const std::int16_t* value = in.at(x - 1, y + row);
    for (int pair = 0; pair < 3 * c.in / 2; ++pair, value += 2, weight += 4)
      for (int p = 0; p < kPixels; ++p) {
        const __m128i v = _mm_set1_epi32(pair_at(value + p * c.in));
        for (int i = 0; i < 4; ++i)
          sums[p][i] = _mm_add_epi32(sums[p][i], _mm_madd_epi16(v, _mm_loadu_si128(weight + i)));
      }
  }
  const __m128i half = _mm_set1_epi32(half_of(c.shift)), shift = _mm_cvtsi32_si128(c.shift);
  const __m128i least = _mm_set1_epi16(static_cast<std::int16_t>(c.least));
  for (int p = 0; p < kPixels; ++p)
    for (int i = 0; i < 4; i += 2) {
      const __m128i low = _mm_sra_epi32(_mm_add_epi32(sums[p][i], half), shift);
      const __m128i high = _mm_sra_epi32(_mm_add_epi32(sums[p][i + 1], half), shift);
      const __m128i both = _mm_min_epi16(_mm_max_epi16(_mm_packs_epi32(low, high), least),
                                         _mm_set1_epi16(kMostValue));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out.at(x + p, y) + 4 * i), both);
    }
}

void row_sse2(const Convolution& c, const ChannelImage& in, int y, ChannelImage& out) {
  constexpr int kTogether = 2;
  int x = 0;
  for (; x + kTogether <= in.width(); x += kTogether) pixels_sse2<kTogether>(c, in, x, y, out);
  if (x == in.width()) return;
  if (x > 0)  // the last few once more with their neighbours: faster than one by one
    return pixels_sse2<kTogether>(c, in, in.width() - kTogether, y, out);
  for (; x < in.width(); ++x) pixels_sse2<1>(c, in, x, y, out);
}

template <int kPixels>
[[gnu::target("avx2")]] void pixels_avx2(const Convolution& c, const ChannelImage& in, int x, int y,
                                         ChannelImage& out) {
  __m256i sums[kPixels][2];
  const auto* bias = reinterpret_cast<const __m256i*>(c.bias.data());
  for (auto& sum : sums) {
    sum[0] = _mm256_loadu_si256(bias);
    sum[1] = _mm256_loadu_si256(bias + 1);
  }
  const auto* weight = reinterpret_cast<const __m256i*>(c.weights.data());
  for (int row = -1; row <= 1; ++row) {
    const std::int16_t* value = in.at(x - 1, y + row);
    for (int pair = 0; pair < 3 * c.in / 2; ++pair, value += 2, weight += 2) {
      const __m256i w0 = _mm256_loadu_si256(weight), w1 = _mm256_loadu_si256(weight + 1);
      for (int p = 0; p < kPixels; ++p) {
        const __m256i v = _mm256_set1_epi32(pair_at(value + p * c.in));
        sums[p][0] = _mm256_add_epi32(sums[p][0], _mm256_madd_epi16(v, w0));
        sums[p][1] = _mm256_add_epi32(sums[p][1], _mm256_madd_epi16(v, w1));
      }
    }
  }
  const __m256i half = _mm256_set1_epi32(half_of(c.shift));
  const __m256i least = _mm256_set1_epi16(static_cast<std::int16_t>(c.least));
  const __m128i shift = _mm_cvtsi32_si128(c.shift);
  for (int p = 0; p < kPixels; ++p) {
    const __m256i low = _mm256_sra_epi32(_mm256_add_epi32(sums[p][0], half), shift);
    const __m256i high = _mm256_sra_epi32(_mm256_add_epi32(sums[p][1], half), shift);
    // Packing works within halves of the register: put the quarters in order again.
    __m256i both = _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0b11'01'10'00);
    both = _mm256_min_epi16(_mm256_max_epi16(both, least), _mm256_set1_epi16(kMostValue));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.at(x + p, y)), both);
  }
}

[[gnu::target("avx2")]] void row_avx2(const Convolution& c, const ChannelImage& in, int y,
                                      ChannelImage& out) {
  constexpr int kTogether = 6;
  int x = 0;
  for (; x + kTogether <= in.width(); x += kTogether) pixels_avx2<kTogether>(c, in, x, y, out);
  if (x == in.width()) return;
  if (x > 0)  // the last few once more with their neighbours: faster than one by one
    return pixels_avx2<kTogether>(c, in, in.width() - kTogether, y, out);
  for (; x < in.width(); ++x) pixels_avx2<1>(c, in, x, y, out);
}

/// All outputs in one register, the pair spread as it is loaded, and the sum with it.
template <int kPixels>
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vnni")]] void pixels_vnni(const Convolution& c,
                                                                         const ChannelImage& in,
                                                                         int x, int y,
                                                                         ChannelImage& out) {
  __m512i sums[kPixels];
  for (__m512i& sum : sums) sum = _mm512_loadu_si512(c.bias.data());
  const std::int16_t* weight = c.weights.data();
  for (int row = -1; row <= 1; ++row) {
    const std::int16_t* value = in.at(x - 1, y + row);
    for (int pair = 0; pair < 3 * c.in / 2; ++pair, value += 2, weight += 2 * kConvolutionOut) {
      const __m512i w = _mm512_loadu_si512(weight);
      for (int p = 0; p < kPixels; ++p)
        sums[p] = _mm512_dpwssd_epi32(sums[p], w, _mm512_set1_epi32(pair_at(value + p * c.in)));
    }
  }
  constexpr __mmask16 kAll = 0xffff;  // gcc 12 warns of its own header without a mask
  const __m512i half = _mm512_set1_epi32(half_of(c.shift));
  const __m256i least = _mm256_set1_epi16(static_cast<std::int16_t>(c.least));
  const __m128i shift = _mm_cvtsi32_si128(c.shift);
  for (int p = 0; p < kPixels; ++p) {
    const __m512i sum = _mm512_maskz_add_epi32(kAll, sums[p], half);
    const __m256i whole =
        _mm512_maskz_cvtsepi32_epi16(kAll, _mm512_maskz_sra_epi32(kAll, sum, shift));
    const __m256i bounded =
        _mm256_min_epi16(_mm256_max_epi16(whole, least), _mm256_set1_epi16(kMostValue));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.at(x + p, y)), bounded);
  }
}

[[gnu::target("avx512f,avx512bw,avx512vl,avx512vnni")]] void row_vnni(const Convolution& c,
                                                                      const ChannelImage& in, int y,
                                                                      ChannelImage& out) {
  constexpr int kTogether = 11;
  int x = 0;
  for (; x + kTogether <= in.width(); x += kTogether) pixels_vnni<kTogether>(c, in, x, y, out);
  if (x == in.width()) return;
  if (x > 0)  // the last few once more with their neighbours: faster than one by one
    return pixels_vnni<kTogether>(c, in, in.width() - kTogether, y, out);
  for (; x < in.width(); ++x) pixels_vnni<1>(c, in, x, y, out);
}

#endif

const ConvolutionVariant& best() {
  static const ConvolutionVariant variant = convolution_variants().back();
  return variant;
}

}  // namespace

ChannelImage::ChannelImage(int width, int height, int channels)
    : width_(width),
      height_(height),
      channels_(channels),
      values_(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2) *
              static_cast<std::size_t>(channels)) {}

std::vector<ConvolutionVariant> convolution_variants() {
  std::vector<ConvolutionVariant> variants{{"plain", row_plain}};
#if defined(__x86_64__)
  variants.push_back({"sse2", row_sse2});
  const core::InstructionSets sets = core::instruction_sets();
  if (sets.avx2) variants.push_back({"avx2", row_avx2});
  if (sets.avx512 && __builtin_cpu_supports("avx512vnni"))
    variants.push_back({"avx512vnni", row_vnni});
#endif
  return variants;
}

void convolve(const ConvolutionVariant& variant, const Convolution& convolution,
              const ChannelImage& in, ChannelImage& out) {
  assert(in.channels() == convolution.in && out.channels() == kConvolutionOut);
  assert(in.width() == out.width() && in.height() == out.height());
  for (int y = 0; y < in.height(); ++y) variant.row(convolution, in, y, out);
}

void convolve(const Convolution& convolution, const ChannelImage& in, ChannelImage& out) {
  convolve(best(), convolution, in, out);
}

}  // namespace nightjar::esi
