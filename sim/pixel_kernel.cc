#include "sim/pixel_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>

#include "sim/instruction_sets.h"
#include "sim/intensity.h"
#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

constexpr auto kDark = static_cast<float>(kDarkOffset);
// Without a linear part the logarithm needs a floor: 1/25,500 of white.
constexpr float kLeastIntensity = 0.01f;
// Beyond any light, and k dt does not overflow over an hour at the greatest cutoff.
constexpr float kMostLuminance = 1e20f;
// Below it the logarithms' own rounding would be off by more than the mean of both ends is
// (either 3e-5, or 6e-4 with the knee between them).
constexpr float kLeastChange = 0.02f;

/// The intensity of one pixel: NaN and infinity give way to `last`, negative
/// values to 0.
float clean_intensity(float luminance_lux, float scale, float last, BadInputs& bad) {
  if (!(std::abs(luminance_lux) <= kMostLuminance)) {
    ++bad.not_finite;
    return last;
  }
  if (luminance_lux < 0) ++bad.negative;
  return luminance_lux > 0 ? luminance_lux * scale : 0.0f;  // and 0 for -0
}

[[gnu::always_inline]] inline float log_intensity(float intensity, const KernelStep& step) {
  const float linear = intensity * step.linear;
  // Bits of positive numbers are in the order of the numbers, and quick to compare.
  const float log = fast_log(std::bit_cast<float>(std::max(
      std::bit_cast<std::int32_t>(intensity), std::bit_cast<std::int32_t>(kLeastIntensity))));
  return select(intensity <= step.knee, linear, log);
}

// The body of advance_pixels, to be compiled for several instruction sets, in short loops
// rather than one: their chains of dependent operations overlap from vector to vector.
// The arrays do not overlap; without `ivdep` the compiler gives up on proving it.

/// All in [0, kMostLuminance]: other values have greater bits, the sign's or
/// the exponent's.
[[gnu::always_inline]] inline bool all_usable(const float* luminance_lux, std::uint32_t count) {
  std::uint32_t greatest = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    greatest = std::max(greatest, std::bit_cast<std::uint32_t>(luminance_lux[i]));
  return greatest <= std::bit_cast<std::uint32_t>(kMostLuminance);
}

/// The integral of the intensity over the log intensity, but for a constant.
[[gnu::always_inline]] inline float area(float intensity, float log, const KernelStep& step) {
  return select(intensity <= step.knee, 0.5f * intensity * log + step.knee_area, intensity);
}

/// Returns the greatest k dt of a pixel, with kLowPass.
template <bool kLowPass>
[[gnu::always_inline]] inline float take_log(const KernelStep& step, const float* luminance_lux,
                                             std::uint32_t count, PixelBlock& block,
                                             BlockStep& result) {
  const KernelStep s = step;   // a copy: the stores below cannot change it
  std::uint32_t greatest = 0;  // bits of positive numbers are in the order of the numbers
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float before = block.intensity[i];
    const float log_before = block.log_intensity[i];
    const float intensity = luminance_lux[i] * s.scale;
    const float log = log_intensity(intensity, s);
    const float change = log - log_before;
    if constexpr (kLowPass) {
      const float exact = (area(intensity, log, s) - area(before, log_before, s)) / change;
      const float mean =
          select(std::abs(change) > kLeastChange, exact, 0.5f * (before + intensity));
      const float kdt = s.decay * (mean + kDark);
      greatest = std::max(greatest, std::bit_cast<std::uint32_t>(kdt));
      result.kdt[i] = kdt;
    }
    result.intensity[i] = before;
    result.change[i] = change;
    block.intensity[i] = intensity;
    block.log_intensity[i] = log;
  }
  return std::bit_cast<float>(greatest);
}

enum class LowPass { none, slow, any };

/// The photoreceptor follows its input: d lag/dt = -k lag - du/dt with constant du/dt over
/// the step. With LowPass::slow, k dt is at most 1 in all pixels, and a polynomial will do.
template <LowPass kLowPass>
[[gnu::always_inline]] inline void follow(const KernelStep& step, std::uint32_t count,
                                          PixelBlock& block, BlockStep& result) {
  const float dt_s = step.dt_s;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    float change = result.change[i];
    if constexpr (kLowPass != LowPass::none) {
      const float lag = block.lag[i];
      const float kdt = result.kdt[i];
      float mean;  // of exp(-k t) over the step
      if constexpr (kLowPass == LowPass::slow) {
        mean = fast_mean_exp(kdt);
      } else {
        // Where k dt is great, nothing is left of the exponential.
        mean = fast_one_minus_exp(select(kdt < 80.0f, kdt, 80.0f)) / kdt;
      }
      const float lost = (lag * kdt + change) * mean;
      result.lag[i] = lag;
      block.lag[i] = lag - lost;
      change -= lost;
    }
    const float before = block.residual[i];
    const float after = before + (change + block.leak_per_s[i] * dt_s);
    result.residual[i] = before;
    block.residual[i] = after;
    result.crossed[i] = static_cast<std::uint8_t>((after >= block.threshold_on[i]) |
                                                  (after <= -block.threshold_off[i]));
  }
}

template <bool kLowPass>
[[gnu::always_inline]] inline void advance_body(const KernelStep& step, const float* luminance_lux,
                                                std::uint32_t count, PixelBlock& block,
                                                BlockStep& result) {
  const float greatest_kdt = take_log<kLowPass>(step, luminance_lux, count, block, result);
  if constexpr (!kLowPass)
    follow<LowPass::none>(step, count, block, result);
  else if (greatest_kdt <= 1.0f)
    follow<LowPass::slow>(step, count, block, result);
  else
    follow<LowPass::any>(step, count, block, result);
}

/// The body of intensities_between.
[[gnu::always_inline]] inline void between_body(const KernelStep& step, const float* before,
                                                const float* after, float share,
                                                std::uint32_t count, float* intensity) {
  const KernelStep s = step;
  const float knee_log = s.knee * s.linear;
  const double per_linear = s.linear > 0 ? 1.0 / s.linear : 0.0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float log_before = log_intensity(before[i], s);
    const float log = log_before + (log_intensity(after[i], s) - log_before) * share;
    const double linear = log * per_linear;
    const bool below = (s.linear > 0) & (log <= knee_log);
    intensity[i] = static_cast<float>(select(below, linear, fast_exp_minus(-log)));
  }
}

bool usable_plain(const float* luminance_lux, std::uint32_t count) {
  return all_usable(luminance_lux, count);
}
void between_plain(const KernelStep& step, const float* before, const float* after, float share,
                   std::uint32_t count, float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
void advance_plain(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                   PixelBlock& block, BlockStep& result) {
  advance_body<kLowPass>(step, luminance_lux, count, block, result);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] bool usable_avx2(const float* luminance_lux, std::uint32_t count) {
  return all_usable(luminance_lux, count);
}
[[gnu::target("avx2")]] void between_avx2(const KernelStep& step, const float* before,
                                          const float* after, float share, std::uint32_t count,
                                          float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
[[gnu::target("avx2")]] void advance_avx2(const KernelStep& step, const float* luminance_lux,
                                          std::uint32_t count, PixelBlock& block,
                                          BlockStep& result) {
  advance_body<kLowPass>(step, luminance_lux, count, block, result);
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] bool usable_avx512(const float* luminance_lux,
                                                                         std::uint32_t count) {
  return all_usable(luminance_lux, count);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void between_avx512(
    const KernelStep& step, const float* before, const float* after, float share,
    std::uint32_t count, float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void advance_avx512(
    const KernelStep& step, const float* luminance_lux, std::uint32_t count, PixelBlock& block,
    BlockStep& result) {
  advance_body<kLowPass>(step, luminance_lux, count, block, result);
}
#endif

const KernelVariant& best() {
  static const KernelVariant variant = kernel_variants().back();
  return variant;
}

void advance_usable(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                    PixelBlock& block, BlockStep& result) {
  std::fill(result.crossed + count, std::end(result.crossed), std::uint8_t{0});
  const auto advance = step.low_pass ? best().with_low_pass : best().without_low_pass;
  advance(step, luminance_lux, count, block, result);
}

}  // namespace

std::vector<KernelVariant> kernel_variants() {
  std::vector<KernelVariant> variants{
      {"plain", usable_plain, advance_plain<true>, advance_plain<false>, between_plain}};
#if defined(__x86_64__)
  if (instruction_sets().avx2)
    variants.push_back(
        {"avx2", usable_avx2, advance_avx2<true>, advance_avx2<false>, between_avx2});
  if (instruction_sets().avx512)
    variants.push_back(
        {"avx512", usable_avx512, advance_avx512<true>, advance_avx512<false>, between_avx512});
#endif
  return variants;
}

BadInputs advance_pixels(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                         PixelBlock& block, BlockStep& result) {
  if (best().usable(luminance_lux, count)) {
    advance_usable(step, luminance_lux, count, block, result);
    return {};
  }
  float intensity[PixelBlock::kPixels];
  const BadInputs bad = clean_intensities(step, luminance_lux, count, block, intensity);
  advance_clean_pixels(step, intensity, count, block, result);
  return bad;
}

BadInputs clean_intensities(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                            const PixelBlock& block, float* intensity) {
  BadInputs bad;
  for (std::uint32_t i = 0; i < count; ++i)
    intensity[i] = clean_intensity(luminance_lux[i], step.scale, block.intensity[i], bad);
  return bad;
}

void advance_clean_pixels(const KernelStep& step, const float* intensity, std::uint32_t count,
                          PixelBlock& block, BlockStep& result) {
  KernelStep unscaled = step;
  unscaled.scale = 1;
  advance_usable(unscaled, intensity, count, block, result);
}

void intensities_between(const KernelStep& step, const float* before, const float* after,
                         float share, std::uint32_t count, float* intensity) {
  best().between(step, before, after, share, count, intensity);
}

double rate_per_intensity(const PixelConfig& config) {
  return 2 * std::numbers::pi * config.cutoff_hz / kWhiteWithOffset;
}

KernelStep kernel_step(const PixelConfig& config, double white_lux) {
  KernelStep step;
  step.scale = static_cast<float>(kWhiteIntensity / white_lux);
  const double knee = config.log_linear_below;
  step.knee = knee > 0 ? static_cast<float>(knee) : -1.0f;
  step.linear = knee > 0 ? static_cast<float>(std::log(knee) / knee) : 0.0f;
  step.knee_area = knee > 0 ? static_cast<float>(knee - knee * std::log(knee) / 2) : 0.0f;
  step.low_pass = config.cutoff_hz > 0;
  return step;
}

void set_step(KernelStep& step, const PixelConfig& config, double dt_s) {
  step.dt_s = static_cast<float>(dt_s);
  step.decay = static_cast<float>(rate_per_intensity(config) * dt_s);
}

BadInputs settle_pixels(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                        PixelBlock& block) {
  BadInputs bad;
  for (std::uint32_t i = 0; i < count; ++i) {
    block.intensity[i] = clean_intensity(luminance_lux[i], step.scale, 0.0f, bad);
    block.log_intensity[i] = log_intensity(block.intensity[i], step);
    block.lag[i] = 0;
  }
  return bad;
}

}  // namespace nightjar::sim
