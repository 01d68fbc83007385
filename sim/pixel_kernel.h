#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensor_config.h"

namespace nightjar::sim {

/// The constants of one dense pass. Intensity is on v2e's scale (white = 255).
struct KernelStep {
  float scale = 1;  ///< Intensity per lux.
  /// Inputs beyond are no light, and k dt does not overflow over an hour at the greatest cutoff.
  float most_luminance_lux = 1e20f;
  float knee = 20;   ///< Linear up to here; -1 = logarithm only.
  float linear = 0;  ///< Log intensity per intensity below the knee.
  /// What makes the integral of the intensity over its log continuous at the knee.
  float knee_area = 0;
  bool low_pass = true;
  float decay = 0;  ///< k dt per unit of (intensity + 20).
  float dt_s = 0;
};

/// State and constants of up to `kPixels` neighbours. All that a step needs of
/// them lies together: arrays of whole pictures would share their cache sets
/// and push each other out.
struct alignas(64) PixelBlock {
  static constexpr std::uint32_t kPixels = 512;

  float intensity[kPixels];
  float log_intensity[kPixels];  ///< Of `intensity`.
  float lag[kPixels];            ///< Photoreceptor output minus log intensity.
  float residual[kPixels];       ///< Photoreceptor output minus what the pixel last
                                 ///< memorised.
  float threshold_on[kPixels];
  float threshold_off[kPixels];
  float leak_per_s[kPixels];
};

/// What a step leaves for those pixels of a block that need a closer look.
struct alignas(64) BlockStep {
  float intensity[PixelBlock::kPixels];  ///< Before the step, as `lag` and
                                         ///< `residual`.
  float lag[PixelBlock::kPixels] = {};   ///< 0 without a low pass.
  float kdt[PixelBlock::kPixels] = {};   ///< The integral of the rate constant over the
                                         ///< step; 0 without a low pass.
  float residual[PixelBlock::kPixels];
  float change[PixelBlock::kPixels];  ///< Of the log intensity.
  /// 1 where the residual has reached a threshold, else 0, also beyond the last pixel.
  std::uint8_t crossed[PixelBlock::kPixels] = {};
};

/// Inputs that had to be corrected.
struct BadInputs {
  std::uint32_t negative = 0;    ///< Counted as 0.
  std::uint32_t not_finite = 0;  ///< Beyond +-1e20 or NaN: the pixel's last value holds.
};

/// Constants for pixels of this config; dt_s and decay are set by `set_step`.
KernelStep kernel_step(const PixelConfig& config, double white_lux);
void set_step(KernelStep& step, const PixelConfig& config, double dt_s);

/// The photoreceptor's rate constant, k = 2 pi f_c (I + 20)/275, in 1/s per
/// unit of (I + 20): v2e emulator_utils.py, cac6384.
double rate_per_intensity(const PixelConfig& config);

/// Advances the first `count` pixels of a block by one step as if none fired:
/// the log intensity is linear over the step, the photoreceptor follows it
/// in closed form at the mean of its rate constant over the step, the leak is
/// added. So what it lagged before decays exactly, and what it lags by the
/// change as far as the rate constant is steady over the step.
/// `luminance_lux` has `count` values. Every instruction set gives the same
/// bits.
BadInputs advance_pixels(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                         PixelBlock& block, BlockStep& result);

/// The intensities that advance_pixels would take `luminance_lux` for.
BadInputs clean_intensities(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                            const PixelBlock& block, float* intensity);

/// As advance_pixels, for intensities of clean_intensities or in between.
void advance_clean_pixels(const KernelStep& step, const float* intensity, std::uint32_t count,
                          PixelBlock& block, BlockStep& result);

/// Intensities at a `share` of the way, from 0 to 1, on which the logarithm of each goes
/// straight from that of `before` to that of `after`. Same bits on every processor.
void intensities_between(const KernelStep& step, const float* before, const float* after,
                         float share, std::uint32_t count, float* intensity);

/// The heart of advance_pixels and intensities_between for one instruction set.
struct KernelVariant {
  /// False, and the block is as before, if any input has to be corrected, be it from -0 to 0.
  using Advance = bool (*)(const KernelStep&, const float* luminance_lux, std::uint32_t count,
                           PixelBlock&, BlockStep&);
  const char* name;
  Advance with_low_pass;
  Advance without_low_pass;
  void (*between)(const KernelStep&, const float* before, const float* after, float share,
                  std::uint32_t count, float* intensity);
};

/// Those this processor can run, slowest first; advance_pixels takes the last
/// of them.
std::vector<KernelVariant> kernel_variants();

/// Starts the first `count` pixels, settled on the input (NaN and infinity
/// count as 0); the residual stays as it is.
BadInputs settle_pixels(const KernelStep& step, const float* luminance_lux, std::uint32_t count,
                        PixelBlock& block);

}  // namespace nightjar::sim
