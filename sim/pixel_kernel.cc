#include "sim/pixel_kernel.h"

#include <cmath>
#include <numbers>

#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

// v2e: inten01 = (I + 20) / 275, so that black pixels are slow but not dead.
constexpr float kDarkOffset = 20.0f;
// Without a linear part the logarithm needs a floor: 1/25,500 of white.
constexpr float kLeastIntensity = 0.01f;
// Beyond any light, and far from overflow.
constexpr float kMostLuminance = 1e30f;

/// NaN and infinity give way to `last`, negative values to 0.
[[gnu::always_inline]] inline float clean_intensity(float luminance, float scale, float last,
                                                    std::uint32_t& bad) {
  const bool known = (luminance >= -kMostLuminance) & (luminance <= kMostLuminance);
  const bool positive = luminance >= 0.0f;
  bad += 1u - static_cast<std::uint32_t>(known & positive);
  return select(known, select(positive, luminance * scale, 0.0f), last);
}

[[gnu::always_inline]] inline float log_intensity(float intensity, const KernelStep& step) {
  const float linear = intensity * step.linear;
  const float log = fast_log(select(intensity > kLeastIntensity, intensity, kLeastIntensity));
  return select(intensity <= step.knee, linear, log);
}

/// The body of advance_pixels, to be compiled for several instruction sets.
template <bool kLowPass>
[[gnu::always_inline]] inline std::uint32_t advance_body(const KernelStep& step,
                                                         const KernelBlock& block,
                                                         std::size_t count) {
  const KernelStep s = step;  // a copy: the stores below cannot change it
  const float* luminance = block.luminance_lux;
  float* intensity = block.intensity;
  float* log = block.log_intensity;
  float* lag = block.lag;
  float* residual = block.residual;
  const float* on = block.threshold_on;
  const float* off = block.threshold_off;
  const float* leak = block.leak_per_s;
  float* intensity_before = block.intensity_before;
  float* log_before = block.log_intensity_before;
  float* lag_before = block.lag_before;
  float* residual_before = block.residual_before;
  std::uint32_t* crossed = block.crossed;

  std::uint32_t bad = 0;
  // The arrays do not overlap; without this the compiler gives up on proving it.
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float i0 = intensity[i];
    const float u0 = log[i];
    const float r0 = residual[i];
    const float i1 = clean_intensity(luminance[i], s.scale, i0, bad);
    const float u1 = log_intensity(i1, s);
    float change = u1 - u0;
    if constexpr (kLowPass) {
      // d lag/dt = -k lag - du/dt with constant du/dt over the step.
      const float lag0 = lag[i];
      const float kdt = s.decay * (i0 + i1 + 2.0f * kDarkOffset);
      const float a = select(kdt < 80.0f, kdt, 80.0f);
      const float lost = fast_one_minus_exp(a);
      const float lag1 = lag0 - lag0 * lost - change * (lost / a);
      lag_before[i] = lag0;
      lag[i] = lag1;
      change += lag1 - lag0;
    }
    const float r1 = r0 + (change + leak[i] * s.dt_s);
    intensity_before[i] = i0;
    log_before[i] = u0;
    residual_before[i] = r0;
    intensity[i] = i1;
    log[i] = u1;
    residual[i] = r1;
    crossed[i] = static_cast<std::uint32_t>((r1 >= on[i]) | (r1 <= -off[i]));
  }
  return bad;
}

template <bool kLowPass>
std::uint32_t advance_plain(const KernelStep& step, const KernelBlock& block, std::size_t count) {
  return advance_body<kLowPass>(step, block, count);
}

#if defined(__x86_64__)
template <bool kLowPass>
[[gnu::target("avx2")]] std::uint32_t advance_avx2(const KernelStep& step, const KernelBlock& block,
                                                   std::size_t count) {
  return advance_body<kLowPass>(step, block, count);
}

template <bool kLowPass>
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] std::uint32_t advance_avx512(
    const KernelStep& step, const KernelBlock& block, std::size_t count) {
  return advance_body<kLowPass>(step, block, count);
}
#endif

}  // namespace

std::vector<KernelVariant> kernel_variants() {
  std::vector<KernelVariant> variants{{"plain", advance_plain<true>, advance_plain<false>}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
    variants.push_back({"avx2", advance_avx2<true>, advance_avx2<false>});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    variants.push_back({"avx512", advance_avx512<true>, advance_avx512<false>});
#endif
  return variants;
}

std::uint32_t advance_pixels(const KernelStep& step, const KernelBlock& block, std::size_t count) {
  static const KernelVariant best = kernel_variants().back();
  return (step.low_pass ? best.with_low_pass : best.without_low_pass)(step, block, count);
}

double rate_per_intensity(const PixelConfig& config) {
  return 2 * std::numbers::pi * config.cutoff_hz / 275;
}

KernelStep kernel_step(const PixelConfig& config, double white_lux) {
  KernelStep step;
  step.scale = static_cast<float>(255 / white_lux);
  const double knee = config.log_linear_below;
  step.knee = knee > 0 ? static_cast<float>(knee) : -1.0f;
  step.linear = knee > 0 ? static_cast<float>(std::log(knee) / knee) : 0.0f;
  step.low_pass = config.cutoff_hz > 0;
  return step;
}

void set_step(KernelStep& step, const PixelConfig& config, double dt_s) {
  step.dt_s = static_cast<float>(dt_s);
  step.decay = static_cast<float>(rate_per_intensity(config) * dt_s / 2);
}

std::uint32_t settle_pixels(const KernelStep& step, const KernelBlock& block, std::size_t count) {
  std::uint32_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    block.intensity[i] = clean_intensity(block.luminance_lux[i], step.scale, 0.0f, bad);
    block.log_intensity[i] = log_intensity(block.intensity[i], step);
    block.lag[i] = 0;
  }
  return bad;
}

}  // namespace nightjar::sim
