#pragma once

#include "core/image.h"
#include "core/random.h"

namespace nightjar::training {

/// A random flat scene of `side_px` square, reflectance 0.01 to 0.98 as floats: uneven ground,
/// shapes, lines, letters and grids of black and white cells (as tags are, but no tags).
core::Image<float> draw_texture(int side_px, core::Random& random);

/// Uniform, and uniform in the logarithm.
double between(double least, double greatest, core::Random& random);
double log_between(double least, double greatest, core::Random& random);

/// Both ends included.
int whole_between(int least, int greatest, core::Random& random);

}  // namespace nightjar::training
