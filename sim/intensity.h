#pragma once

namespace nightjar::sim {

// Intensity is on v2e's scale, white = 255. Photoreceptor and shot noise go by
// (I + 20)/275: black pixels are slow but not dead, and white counts 1 (v2e
// emulator_utils.py, rescale_intensity_frame, cac6384).
inline constexpr double kWhiteIntensity = 255;
inline constexpr double kDarkOffset = 20;
inline constexpr double kWhiteWithOffset = kWhiteIntensity + kDarkOffset;

}  // namespace nightjar::sim
