#pragma once

#include <cmath>
#include <numbers>

namespace nightjar::tracker {

/// The same angle in [-pi, pi].
inline double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

}  // namespace nightjar::tracker
