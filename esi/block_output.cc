#include "esi/block_output.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/instruction_sets.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nightjar::esi {

void BlockOutput::set_weights(std::span<const std::int16_t> weights,
                              std::span<const std::int32_t, kPixels> bias) {
  assert(weights.size() % (2 * kPixels) == 0);
  weights_.resize(2 * weights.size());
  std::ranges::copy(bias, bias_.begin());
  const std::size_t values = weights.size() / kPixels;
  for (std::size_t i = 0; i < kPixels; ++i)
    for (std::size_t k = 0; k < values; ++k)
      for (std::size_t copy = 0; copy < 2; ++copy)
        weights_[((k / 2 * 2 + copy) * kPixels + i) * 2 + k % 2] = weights[i * values + k];
}

BlockOutput::Levels BlockOutput::levels_of(std::span<const std::int16_t> hidden,
                                           std::span<const std::int16_t> features,
                                           std::int32_t shade) const {
  std::array<std::int32_t, kPixels> sums = bias_;
  for (std::int32_t& sum : sums) sum += shade;
  const std::int16_t* weight = weights_.data();
  for (const auto values : {hidden, features})
    for (std::size_t k = 0; k < values.size(); k += 2, weight += 4 * kPixels)
      for (std::size_t i = 0; i < kPixels; ++i)
        sums[i] += weight[2 * i] * values[k] + weight[2 * i + 1] * values[k + 1];
  Levels levels;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float level = 127.5f + levels_ * static_cast<float>(sums[i]);
    levels[i] = static_cast<std::uint8_t>(std::clamp(level, 0.0f, 255.0f) + 0.5f);
  }
  return levels;
}

#if defined(__x86_64__)

namespace {

constexpr int kTogether = 8;  // values of a block that half a register holds

/// Two blocks' four sums each, with what `left` and `right` give; `weight` goes on by as many.
[[gnu::target("avx2")]] __m256i add_products(__m256i sums, const __m256i*& weight,
                                             const std::int16_t* left, const std::int16_t* right,
                                             std::size_t count) {
  for (std::size_t k = 0; k < count; k += kTogether, weight += kTogether / 2) {
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(left + k));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(right + k));
    const __m256i values = _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
    const __m256i pairs[] = {
        _mm256_shuffle_epi32(values, 0b00'00'00'00), _mm256_shuffle_epi32(values, 0b01'01'01'01),
        _mm256_shuffle_epi32(values, 0b10'10'10'10), _mm256_shuffle_epi32(values, 0b11'11'11'11)};
    for (int i = 0; i < 4; ++i)
      sums = _mm256_add_epi32(sums, _mm256_madd_epi16(pairs[i], _mm256_loadu_si256(weight + i)));
  }
  return sums;
}

}  // namespace

[[gnu::target("avx2")]] int BlockOutput::write_row_avx2(const ChannelImage& hidden,
                                                        const ChannelImage& features,
                                                        const core::Image<std::int32_t>& shade,
                                                        int row,
                                                        core::Image<std::uint8_t>& gray) const {
  const auto hidden_count = static_cast<std::size_t>(hidden.channels());
  const auto feature_count = static_cast<std::size_t>(features.channels());
  const __m256i bias =
      _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bias_.data())));
  int x = 0;
  for (; x + 4 <= gray.width(); x += 4) {
    const auto* weight = reinterpret_cast<const __m256i*>(weights_.data());
    const __m256i shades =
        _mm256_set_m128i(_mm_set1_epi32(shade(x / 2 + 1, row)), _mm_set1_epi32(shade(x / 2, row)));
    __m256i sums = add_products(_mm256_add_epi32(bias, shades), weight, hidden.at(x / 2, row),
                                hidden.at(x / 2 + 1, row), hidden_count);
    sums = add_products(sums, weight, features.at(x / 2, row), features.at(x / 2 + 1, row),
                        feature_count);
    __m256 level = _mm256_add_ps(_mm256_set1_ps(127.5f),
                                 _mm256_mul_ps(_mm256_set1_ps(levels_), _mm256_cvtepi32_ps(sums)));
    level = _mm256_min_ps(_mm256_max_ps(level, _mm256_setzero_ps()), _mm256_set1_ps(255.0f));
    const __m256i whole = _mm256_cvttps_epi32(_mm256_add_ps(level, _mm256_set1_ps(0.5f)));
    const __m256i words = _mm256_packs_epi32(whole, whole);
    const __m256i bytes = _mm256_packus_epi16(words, words);
    const __m128i rows =
        _mm_unpacklo_epi16(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
    const std::int64_t both = _mm_cvtsi128_si64(rows);  // the upper row's four, the lower one's
    std::memcpy(&gray(x, 2 * row), &both, 4);
    if (2 * row + 1 < gray.height())
      std::memcpy(&gray(x, 2 * row + 1), reinterpret_cast<const char*>(&both) + 4, 4);
  }
  return x;
}

#endif

void BlockOutput::write_row(const ChannelImage& hidden, const ChannelImage& features,
                            const core::Image<std::int32_t>& shade, int row, int from,
                            core::Image<std::uint8_t>& gray) const {
  for (int x = from; x < gray.width(); x += 2) {
    const Levels levels =
        levels_of({hidden.at(x / 2, row), static_cast<std::size_t>(hidden.channels())},
                  {features.at(x / 2, row), static_cast<std::size_t>(features.channels())},
                  shade(x / 2, row));
    const std::size_t count = x + 1 < gray.width() ? 2 : 1;
    std::memcpy(&gray(x, 2 * row), levels.data(), count);
    if (2 * row + 1 < gray.height()) std::memcpy(&gray(x, 2 * row + 1), levels.data() + 2, count);
  }
}

void BlockOutput::write(const ChannelImage& hidden, const ChannelImage& features,
                        const core::Image<std::int32_t>& shade,
                        core::Image<std::uint8_t>& gray) const {
  assert(weights_.size() ==
         2u * kPixels * static_cast<std::size_t>(hidden.channels() + features.channels()));
  assert(hidden.width() == features.width() && hidden.height() == features.height());
  assert(hidden.width() == shade.width() && hidden.height() == shade.height());
  assert(hidden.width() == (gray.width() + 1) / 2 && hidden.height() == (gray.height() + 1) / 2);
#if defined(__x86_64__)
  const bool two_at_once = core::instruction_sets().avx2 && hidden.channels() % kTogether == 0 &&
                           features.channels() % kTogether == 0;
#endif
  for (int row = 0; row < hidden.height(); ++row) {
    int x = 0;
#if defined(__x86_64__)
    if (two_at_once) x = write_row_avx2(hidden, features, shade, row, gray);
#endif
    write_row(hidden, features, shade, row, x, gray);
  }
}

}  // namespace nightjar::esi
