#pragma once

#include "core/image.h"

namespace nightjar::esi {

/// How like a reference a picture is, once its grey levels have been fitted to it.
struct Quality {
  double gain = 0;  ///< Reference ~ gain * picture + offset_levels; never below 0.
  double offset_levels = 0;
  double mse = 0;      ///< Mean squared error, grey levels squared.
  double psnr_db = 0;  ///< 10 log10(255^2 / mse); infinite where mse = 0.
  double ssim = 0;     ///< Mean structural similarity, at most 1.
};

/// Compares after the affine change of the picture's grey levels that brings it nearest to
/// the reference in the least-squares sense, for a picture made of events tells neither its
/// brightness nor its contrast. The gain is not negative, or a negative picture would pass.
///
/// SSIM as Wang et al. (IEEE Trans. Image Processing 13, 2004): Gaussian window of 11x11 px
/// with sigma 1.5 px where it fits whole, K1 = 0.01, K2 = 0.03, L = 255.
///
/// Throws std::invalid_argument for pictures of different sizes, or under 11 px a side.
Quality compare(const core::Image<std::uint8_t>& picture,
                const core::Image<std::uint8_t>& reference);

}  // namespace nightjar::esi
