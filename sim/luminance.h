#pragma once

namespace nightjar::sim {

/// Of linear red, green and blue: the luma coefficients of Rec. ITU-R BT.709.
inline float luminance(float red, float green, float blue) {
  return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

}  // namespace nightjar::sim
