#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/sensor_config.h"

namespace nightjar::sim {

/// The constants of one dense pass. Intensity is on v2e's scale (white = 255).
struct KernelStep {
  float scale = 1;   ///< Intensity per lux.
  float knee = 20;   ///< Linear up to here; -1 = logarithm only.
  float linear = 0;  ///< Log intensity per intensity below the knee.
  bool low_pass = true;
  float decay = 0;  ///< k dt per unit of (intensity + 20) summed over both ends.
  float dt_s = 0;
};

/// Pixels of one block: arrays of the same length that do not overlap. The state is
/// replaced; what it was is left in `..._before` for the pixels that need a closer look.
struct KernelBlock {
  const float* luminance_lux;
  // State.
  float* intensity;
  float* log_intensity;  ///< u
  float* lag;            ///< Photoreceptor output minus u.
  float* residual;       ///< Photoreceptor output minus what the pixel last memorised.
  // Constants.
  const float* threshold_on;
  const float* threshold_off;
  const float* leak_per_s;
  // Results.
  float* intensity_before;
  float* log_intensity_before;
  float* lag_before;
  float* residual_before;
  std::uint32_t* crossed;  ///< 1 where the residual has reached a threshold, else 0.
};

/// Constants for pixels of this config; dt_s and decay are set by `set_step`.
KernelStep kernel_step(const PixelConfig& config, double white_lux);
void set_step(KernelStep& step, const PixelConfig& config, double dt_s);

/// The photoreceptor's rate constant, k = 2 pi f_c (I + 20)/275, in 1/s per unit of
/// (I + 20): v2e emulator_utils.py, cac6384.
double rate_per_intensity(const PixelConfig& config);

/// Advances `count` pixels by one step as if none fired: the log intensity is linear
/// over the step, the photoreceptor follows it exactly at the mean of its rate
/// constants at both ends, the leak is added. Returns how many inputs were corrected.
/// Every instruction set gives the same bits.
std::uint32_t advance_pixels(const KernelStep& step, const KernelBlock& block, std::size_t count);

/// advance_pixels for one instruction set.
struct KernelVariant {
  using Advance = std::uint32_t (*)(const KernelStep&, const KernelBlock&, std::size_t);
  const char* name;
  Advance with_low_pass;
  Advance without_low_pass;
};

/// Those this processor can run, slowest first; advance_pixels is the last of them.
std::vector<KernelVariant> kernel_variants();

/// Starts `count` pixels, settled on the input; the residual stays as it is. Returns how
/// many inputs were corrected (NaN and infinity to 0).
std::uint32_t settle_pixels(const KernelStep& step, const KernelBlock& block, std::size_t count);

}  // namespace nightjar::sim
