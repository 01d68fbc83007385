#pragma once

#include <cstdint>
#include <vector>

namespace nightjar::sim {

/// What turns a pixel's charge into a code of the converter.
struct ApsConversion {
  float read_variance_e2 = 0;
  float full_well_e = 25000;
  float codes_per_e = 1;
  float black_codes = 0;
  float most_codes = 1023;  ///< Codes go from 0 to here.
  int dropped_bits = 0;     ///< The lowest of a code.
};

/// So many pixels are read at once; half as many draws give their noise.
inline constexpr std::uint32_t kApsBatch = 512;

/// One 64-bit draw for two pixels, in halves.
struct alignas(64) ApsDraws {
  std::uint32_t high[kApsBatch / 2], low[kApsBatch / 2];
};

/// What the active pixels do many at a time, for one instruction set. Light is in lux; NaN
/// and negative values count as 0, those beyond 1e12 lux as that. Arrays do not overlap.
/// Every instruction set gives the same bits.
struct ApsVariant {
  const char* name;
  /// Copies `count` values to `light_lux` as they count. Returns how many were NaN, infinite
  /// or negative.
  std::uint32_t (*take)(const float* luminance_lux, std::uint32_t count, float* light_lux);
  /// Adds to the charges `before_s` times the light before and `now_s` times `luminance_lux`.
  void (*integrate)(const float* light_before_lux, float before_s, const float* luminance_lux,
                    float now_s, std::uint32_t count, float* charge_lux_s);
  /// Reads up to kApsBatch pixels and empties them. Shot and read noise come from one normal
  /// deviate a pixel: fast_normal_pair of a draw for a pixel and that half a batch on.
  void (*read)(const ApsConversion& conversion, const ApsDraws& draws, const float* gain_e_lux_s,
               const float* offset_e, std::uint32_t count, float* charge_lux_s,
               std::uint16_t* gray);
};

/// Those this processor can run, slowest first.
std::vector<ApsVariant> aps_variants();

/// The last of them.
const ApsVariant& best_aps_variant();

}  // namespace nightjar::sim
