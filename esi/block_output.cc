#include "esi/block_output.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace nightjar::esi {

BlockOutput::BlockOutput(std::span<const std::int16_t> weights,
                         std::span<const std::int32_t, kPixels> bias, float levels)
    : weights_(weights.size()), levels_(levels) {
  assert(weights.size() % (2 * kPixels) == 0);
  std::ranges::copy(bias, bias_.begin());
  const std::size_t values = weights.size() / kPixels;
  for (std::size_t i = 0; i < kPixels; ++i)
    for (std::size_t k = 0; k < values; ++k)
      weights_[(k / 2 * kPixels + i) * 2 + k % 2] = weights[i * values + k];
}

#if defined(__SSE2__)

namespace {

/// The four pixels' sums, with what `values` give; `weight` goes on by as many.
__m128i add_products(__m128i sums, const std::int16_t*& weight,
                     std::span<const std::int16_t> values) {
  for (std::size_t k = 0; k < values.size(); k += 2, weight += 2 * BlockOutput::kPixels) {
    int two;
    std::memcpy(&two, values.data() + k, sizeof(two));
    const __m128i weights = _mm_loadu_si128(reinterpret_cast<const __m128i*>(weight));
    sums = _mm_add_epi32(sums, _mm_madd_epi16(_mm_set1_epi32(two), weights));
  }
  return sums;
}

}  // namespace

BlockOutput::Levels BlockOutput::levels_of(std::span<const std::int16_t> hidden,
                                           std::span<const std::int16_t> features) const {
  const std::int16_t* weight = weights_.data();
  __m128i sums = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bias_.data()));
  sums = add_products(sums, weight, hidden);
  sums = add_products(sums, weight, features);
  __m128 level =
      _mm_add_ps(_mm_set1_ps(127.5f), _mm_mul_ps(_mm_set1_ps(levels_), _mm_cvtepi32_ps(sums)));
  level = _mm_min_ps(_mm_max_ps(level, _mm_setzero_ps()), _mm_set1_ps(255.0f));
  const __m128i whole = _mm_cvttps_epi32(_mm_add_ps(level, _mm_set1_ps(0.5f)));
  const __m128i words = _mm_packs_epi32(whole, whole);
  const int bytes = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
  Levels levels;
  std::memcpy(levels.data(), &bytes, sizeof(bytes));
  return levels;
}

#else

BlockOutput::Levels BlockOutput::levels_of(std::span<const std::int16_t> hidden,
                                           std::span<const std::int16_t> features) const {
  std::array<std::int32_t, kPixels> sums = bias_;
  const std::int16_t* weight = weights_.data();
  for (const auto values : {hidden, features})
    for (std::size_t k = 0; k < values.size(); k += 2, weight += 2 * kPixels)
      for (std::size_t i = 0; i < kPixels; ++i)
        sums[i] += weight[2 * i] * values[k] + weight[2 * i + 1] * values[k + 1];
  Levels levels;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float level = 127.5f + levels_ * static_cast<float>(sums[i]);
    levels[i] = static_cast<std::uint8_t>(std::clamp(level, 0.0f, 255.0f) + 0.5f);
  }
  return levels;
}

#endif

void BlockOutput::write(const ChannelImage& hidden, const ChannelImage& features,
                        core::Image<std::uint8_t>& gray) const {
  const auto hidden_count = static_cast<std::size_t>(hidden.channels());
  const auto feature_count = static_cast<std::size_t>(features.channels());
  assert(weights_.size() == kPixels * (hidden_count + feature_count));
  assert(hidden.width() == features.width() && hidden.height() == features.height());
  assert(hidden.width() == (gray.width() + 1) / 2 && hidden.height() == (gray.height() + 1) / 2);
  for (int y = 0; y < gray.height(); y += 2) {
    const bool has_lower = y + 1 < gray.height();
    std::uint8_t* upper = &gray(0, y);
    std::uint8_t* lower = has_lower ? &gray(0, y + 1) : nullptr;
    for (int x = 0; x < gray.width(); x += 2) {
      const Levels levels = levels_of({hidden.at(x / 2, y / 2), hidden_count},
                                      {features.at(x / 2, y / 2), feature_count});
      const std::size_t count = x + 1 < gray.width() ? 2 : 1;
      std::memcpy(upper + x, levels.data(), count);
      if (has_lower) std::memcpy(lower + x, levels.data() + 2, count);
    }
  }
}

}  // namespace nightjar::esi
