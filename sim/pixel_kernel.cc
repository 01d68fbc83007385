#include "sim/pixel_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/instruction_sets.h"
#include "sim/intensity.h"
#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

constexpr auto kDark = static_cast<float>(kDarkOffset);
// Without a linear part the logarithm needs a floor: 1/25,500 of white.
constexpr float kLeastIntensity = 0.01f;
// Below it the logarithms' own rounding would be off by more than the mean of both ends is
// with the knee between them (6e-4).
constexpr float kLeastChange = 0.02f;
// Of the log intensity, as far as the polynomial for the mean goes.
constexpr float kMostChange = 1.0f;

/// The intensity of one pixel: NaN and infinity give way to `last`, negative
/// values to 0.
float clean_intensity(float luminance_lux, const KernelStep& step, float last, BadInputs& bad) {
  if (!(std::abs(luminance_lux) <= step.most_luminance_lux)) {
    ++bad.not_finite;
    return last;
  }
  if (luminance_lux < 0) ++bad.negative;
  return luminance_lux > 0 ? luminance_lux * step.scale : 0.0f;  // and 0 for -0
}

[[gnu::always_inline]] inline float log_intensity(float intensity, const KernelStep& step) {
  const float linear = intensity * step.linear;
  // Bits of positive numbers are in the order of the numbers, and quick to compare.
  const float log = fast_log<Fused>(std::bit_cast<float>(std::max(
      std::bit_cast<std::int32_t>(intensity), std::bit_cast<std::int32_t>(kLeastIntensity))));
  return select(intensity <= step.knee, linear, log);
}

// The body of advance_pixels, to be compiled for several instruction sets, in short loops
// rather than one: their chains of dependent operations overlap from vector to vector.
// The arrays do not overlap; without `ivdep` the compiler gives up on proving it.

/// The integral of the intensity over the log intensity, but for a constant.
[[gnu::always_inline]] inline float area(float intensity, float log, const KernelStep& step) {
  return select(intensity <= step.knee, 0.5f * intensity * log + step.knee_area, intensity);
}

// In all that follows, bits of positive numbers are in the order of the numbers; other values
// have greater bits, the sign's or the exponent's.

/// Updates the intensities and their logarithms. Returns the greatest input, as bits.
[[gnu::always_inline]] inline std::uint32_t take_log(const KernelStep& step,
                                                     const float* luminance_lux,
                                                     std::uint32_t count, PixelBlock& block,
                                                     BlockStep& result) {
  const KernelStep s = step;  // a copy: the stores below cannot change it
  std::uint32_t greatest = 0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float intensity = luminance_lux[i] * s.scale;
    const float log = log_intensity(intensity, s);
    greatest = std::max(greatest, std::bit_cast<std::uint32_t>(luminance_lux[i]));
    result.intensity[i] = block.intensity[i];
    result.change[i] = log - block.log_intensity[i];
    block.intensity[i] = intensity;
    block.log_intensity[i] = log;
  }
  return greatest;
}

/// Sets k dt where the way is not short: where the log intensity passes the knee or changes by
/// more than kMostChange. Returns the greatest k dt.
[[gnu::always_inline]] inline float take_long_ways(const KernelStep& step, std::uint32_t count,
                                                   const PixelBlock& block, BlockStep& result) {
  const KernelStep s = step;
  std::uint32_t greatest_kdt = 0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float before = result.intensity[i], after = block.intensity[i];
    const float log = block.log_intensity[i], change = result.change[i];
    const float mean = (area(after, log, s) - area(before, log - change, s)) / change;
    const bool above = (before > s.knee) & (after > s.knee);
    const float kdt = select(std::abs(change) > select(above, kMostChange, kLeastChange),
                             s.decay * (mean + kDark), result.kdt[i]);
    greatest_kdt = std::max(greatest_kdt, std::bit_cast<std::uint32_t>(kdt));
    result.kdt[i] = kdt;
  }
  return std::bit_cast<float>(greatest_kdt);
}

/// Sets k dt by the mean intensity of the step. Returns the greatest.
[[gnu::always_inline]] inline float take_rates(const KernelStep& step, std::uint32_t count,
                                               const PixelBlock& block, BlockStep& result) {
  constexpr Fused fma;
  const KernelStep s = step;
  const float dark_kdt = s.decay * kDark;
  const std::int32_t knee_bits = s.knee > 0 ? std::bit_cast<std::int32_t>(s.knee) : -1;
  std::uint32_t greatest_kdt = 0, long_ways = 0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float before = result.intensity[i], after = block.intensity[i];
    const float change = result.change[i];
    const float less = select(after <= s.knee, 0.0f, log_mean_deficit(after - before, change));
    const float kdt = fma(fma(before + after, 0.5f, -less), s.decay, dark_kdt);
    greatest_kdt = std::max(greatest_kdt, std::bit_cast<std::uint32_t>(kdt));
    // Negative if the way is not short: the sign of a difference takes the fewest operations.
    const std::int32_t passes_knee = (knee_bits - std::bit_cast<std::int32_t>(before)) ^
                                     (knee_bits - std::bit_cast<std::int32_t>(after));
    const std::int32_t changes_little =
        std::bit_cast<std::int32_t>(kMostChange) - std::bit_cast<std::int32_t>(std::abs(change));
    long_ways |= static_cast<std::uint32_t>(passes_knee | changes_little);
    result.kdt[i] = kdt;
  }
  return static_cast<std::int32_t>(long_ways) < 0 ? take_long_ways(step, count, block, result)
                                                  : std::bit_cast<float>(greatest_kdt);
}

/// Undoes take_log: the logarithm of an intensity always has the same bits.
[[gnu::noinline]] void put_back(const KernelStep& step, std::uint32_t count,
                                const BlockStep& result, PixelBlock& block) {
  for (std::uint32_t i = 0; i < count; ++i) {
    block.intensity[i] = result.intensity[i];
    block.log_intensity[i] = log_intensity(block.intensity[i], step);
  }
}

enum class LowPass { none, slow, any };

/// The photoreceptor follows its input: d lag/dt = -k lag - du/dt with constant du/dt over
/// the step. With LowPass::slow, k dt is at most 1 in all pixels, and a polynomial will do.
template <LowPass kLowPass>
[[gnu::always_inline]] inline void follow(const KernelStep& step, std::uint32_t count,
                                          PixelBlock& block, BlockStep& result) {
  constexpr Fused fma;
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
      const float losing = fma(lag, kdt, change);
      result.lag[i] = lag;
      block.lag[i] = fma(-losing, mean, lag);
      change = fma(-losing, mean, change);
    }
    const float before = block.residual[i];
    const float after = before + fma(block.leak_per_s[i], dt_s, change);
    result.residual[i] = before;
    block.residual[i] = after;
    result.crossed[i] = static_cast<std::uint8_t>((after >= block.threshold_on[i]) |
                                                  (after <= -block.threshold_off[i]));
  }
}

/// False, and the block is as before, if an input has to be corrected.
template <bool kLowPass>
[[gnu::always_inline]] inline bool advance_body(const KernelStep& step, const float* luminance_lux,
                                                std::uint32_t count, PixelBlock& block,
                                                BlockStep& result) {
  const std::uint32_t greatest_input = take_log(step, luminance_lux, count, block, result);
  if (greatest_input > std::bit_cast<std::uint32_t>(step.most_luminance_lux)) {
    put_back(step, count, result, block);
    return false;
  }
  if constexpr (!kLowPass)
    follow<LowPass::none>(step, count, block, result);
  else if (take_rates(step, count, block, result) <= 1.0f)
    follow<LowPass::slow>(step, count, block, result);
  else
    follow<LowPass::any>(step, count, block, result);
  return true;
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

void between_plain(const KernelStep& step, const float* before, const float* after, float share,
                   std::uint32_t count, float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
bool advance_plain(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                   PixelBlock& block, BlockStep& result) {
  return advance_body<kLowPass>(step, luminance_lux, count, block, result);
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void between_avx2(const KernelStep& step, const float* before,
                                              const float* after, float share, std::uint32_t count,
                                              float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
[[gnu::target("avx2,fma")]] bool advance_avx2(const KernelStep& step, const float* luminance_lux,
                                              std::uint32_t count, PixelBlock& block,
                                              BlockStep& result) {
  return advance_body<kLowPass>(step, luminance_lux, count, block, result);
}

[[gnu::target("fma,avx512f,avx512bw,avx512dq,avx512vl")]] void between_avx512(
    const KernelStep& step, const float* before, const float* after, float share,
    std::uint32_t count, float* intensity) {
  between_body(step, before, after, share, count, intensity);
}
template <bool kLowPass>
[[gnu::target("fma,avx512f,avx512bw,avx512dq,avx512vl")]] bool advance_avx512(
    const KernelStep& step, const float* luminance_lux, std::uint32_t count, PixelBlock& block,
    BlockStep& result) {
  return advance_body<kLowPass>(step, luminance_lux, count, block, result);
}
#endif

const KernelVariant& best() {
  static const KernelVariant variant = kernel_variants().back();
  return variant;
}

bool advance_usable(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                    PixelBlock& block, BlockStep& result) {
  std::fill(result.crossed + count, std::end(result.crossed), std::uint8_t{0});
  const auto advance = step.low_pass ? best().with_low_pass : best().without_low_pass;
  return advance(step, luminance_lux, count, block, result);
}

}  // namespace

std::vector<KernelVariant> kernel_variants() {
  std::vector<KernelVariant> variants{
      {"plain", advance_plain<true>, advance_plain<false>, between_plain}};
#if defined(__x86_64__)
  if (core::instruction_sets().avx2)
    variants.push_back({"avx2", advance_avx2<true>, advance_avx2<false>, between_avx2});
  if (core::instruction_sets().avx512)
    variants.push_back({"avx512", advance_avx512<true>, advance_avx512<false>, between_avx512});
#endif
  return variants;
}

BadInputs advance_pixels(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                         PixelBlock& block, BlockStep& result) {
  if (advance_usable(step, luminance_lux, count, block, result)) return {};
  float intensity[PixelBlock::kPixels];
  const BadInputs bad = clean_intensities(step, luminance_lux, count, block, intensity);
  advance_clean_pixels(step, intensity, count, block, result);
  return bad;
}

BadInputs clean_intensities(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                            const PixelBlock& block, float* intensity) {
  BadInputs bad;
  for (std::uint32_t i = 0; i < count; ++i)
    intensity[i] = clean_intensity(luminance_lux[i], step, block.intensity[i], bad);
  return bad;
}

void advance_clean_pixels(const KernelStep& step, const float* intensity, std::uint32_t count,
                          PixelBlock& block, BlockStep& result) {
  KernelStep unscaled = step;
  unscaled.scale = 1;
  unscaled.most_luminance_lux = std::numeric_limits<float>::max();
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
    block.intensity[i] = clean_intensity(luminance_lux[i], step, 0.0f, bad);
    block.log_intensity[i] = log_intensity(block.intensity[i], step);
    block.lag[i] = 0;
  }
  return bad;
}

}  // namespace nightjar::sim
