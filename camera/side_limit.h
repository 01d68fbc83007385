#pragma once

namespace nightjar::camera {

/// Pixels a sensor or a frame may have on a side, so that their number fits an int.
inline constexpr int kMostSidePx = 32767;

}  // namespace nightjar::camera
