#include "sim/aps_kernel.h"

#include <algorithm>
#include <limits>

#include "core/instruction_sets.h"
#include "sim/pixel_math.h"

namespace nightjar::sim {
namespace {

// Infinite light saturates without spoiling sums.
constexpr float kMostLux = 1e12f;

[[gnu::always_inline]] inline float usable(float luminance_lux) {
  return select(luminance_lux > 0, select(luminance_lux < kMostLux, luminance_lux, kMostLux), 0.0f);
}

[[gnu::always_inline]] inline std::uint32_t take_body(const float* luminance_lux,
                                                      std::uint32_t count, float* light_lux) {
  std::uint32_t bad = 0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const float lux = luminance_lux[i];
    bad +=
        1 - static_cast<std::uint32_t>((lux >= 0) & (lux < std::numeric_limits<float>::infinity()));
    light_lux[i] = usable(lux);
  }
  return bad;
}

[[gnu::always_inline]] inline void integrate_body(const float* light_before_lux, float before_s,
                                                  const float* luminance_lux, float now_s,
                                                  std::uint32_t count, float* charge_lux_s) {
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i)
    charge_lux_s[i] += before_s * light_before_lux[i] + now_s * usable(luminance_lux[i]);
}

[[gnu::always_inline]] inline void read_body(const ApsConversion& conversion, const ApsDraws& draws,
                                             const float* gain_e_lux_s, const float* offset_e,
                                             std::uint32_t count, float* charge_lux_s,
                                             std::uint16_t* gray) {
  alignas(64) float noise[kApsBatch];
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < kApsBatch / 2; ++i) {
    const NormalPair pair = fast_normal_pair(draws.high[i], draws.low[i]);
    noise[i] = pair.first;
    noise[i + kApsBatch / 2] = pair.second;
  }
  const ApsConversion c = conversion;  // a copy: the stores below cannot change it
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    // Photons are counted by the hundreds here, where Poisson is all but Gaussian.
    const float photo_e = charge_lux_s[i] * gain_e_lux_s[i];
    const float noise_e = fast_sqrt(photo_e + c.read_variance_e2) * noise[i];
    const float read_e = photo_e + noise_e + offset_e[i];
    const float stored_e = select(read_e < c.full_well_e, read_e, c.full_well_e);
    const float code = c.black_codes + c.codes_per_e * stored_e;
    const float in_range = select(code > 0, select(code < c.most_codes, code, c.most_codes), 0.0f);
    gray[i] =
        static_cast<std::uint16_t>(static_cast<std::int32_t>(in_range + 0.5f) >> c.dropped_bits);
    charge_lux_s[i] = 0;
  }
}

std::uint32_t take_plain(const float* luminance_lux, std::uint32_t count, float* light_lux) {
  return take_body(luminance_lux, count, light_lux);
}
void integrate_plain(const float* light_before_lux, float before_s, const float* luminance_lux,
                     float now_s, std::uint32_t count, float* charge_lux_s) {
  integrate_body(light_before_lux, before_s, luminance_lux, now_s, count, charge_lux_s);
}
void read_plain(const ApsConversion& conversion, const ApsDraws& draws, const float* gain_e_lux_s,
                const float* offset_e, std::uint32_t count, float* charge_lux_s,
                std::uint16_t* gray) {
  read_body(conversion, draws, gain_e_lux_s, offset_e, count, charge_lux_s, gray);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] std::uint32_t take_avx2(const float* luminance_lux, std::uint32_t count,
                                                float* light_lux) {
  return take_body(luminance_lux, count, light_lux);
}
[[gnu::target("avx2")]] void integrate_avx2(const float* light_before_lux, float before_s,
                                            const float* luminance_lux, float now_s,
                                            std::uint32_t count, float* charge_lux_s) {
  integrate_body(light_before_lux, before_s, luminance_lux, now_s, count, charge_lux_s);
}
[[gnu::target("avx2")]] void read_avx2(const ApsConversion& conversion, const ApsDraws& draws,
                                       const float* gain_e_lux_s, const float* offset_e,
                                       std::uint32_t count, float* charge_lux_s,
                                       std::uint16_t* gray) {
  read_body(conversion, draws, gain_e_lux_s, offset_e, count, charge_lux_s, gray);
}
#endif

}  // namespace

std::vector<ApsVariant> aps_variants() {
  std::vector<ApsVariant> variants{{"plain", take_plain, integrate_plain, read_plain}};
#if defined(__x86_64__)
  if (core::instruction_sets().avx2)
    variants.push_back({"avx2", take_avx2, integrate_avx2, read_avx2});
#endif
  return variants;
}

const ApsVariant& best_aps_variant() {
  static const ApsVariant variant = aps_variants().back();
  return variant;
}

}  // namespace nightjar::sim
