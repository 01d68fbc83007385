#pragma once

#include <array>
#include <cstdint>

#include "core/event.h"
#include "core/image.h"

namespace nightjar::scenarios {

/// Reflectances of the grey bars, from left to right.
inline constexpr std::array<double, 4> kGreyBars = {0.1, 0.3, 0.6, 0.9};

/// Four upright bars of grey: what a camera sees of a scene at rest. Luminance in lux,
/// `white_lux` being a white surface.
core::Image<float> grey_bars(core::Resolution size, double white_lux);

/// A random texture that moves to the left across the middle half of the rows; the grey
/// bars stand still above and below. The logarithm of the texture's reflectance is a sum
/// of plane waves of 8 to 64 px in random directions, as many in each octave, with the
/// mean ln 0.25 and the standard deviation 0.4.
class MovingPattern {
 public:
  /// The pictures from time 0 to `duration_s`, and two at least.
  MovingPattern(core::Resolution size, double white_lux, double speed_px_s, double duration_s,
                std::uint64_t seed);

  /// The texture moves by a quarter of a pixel in that time.
  core::Time interval() const { return interval_; }
  int pictures() const { return pictures_; }

  /// Picture `index` (0 to pictures() - 1), as it is at index * interval().
  const core::Image<float>& draw(int index);

 private:
  core::Time interval_;
  int pictures_;
  core::Image<float> strip_lux_;  ///< All of the texture, four columns to a pixel.
  core::Image<float> picture_lux_;
};

}  // namespace nightjar::scenarios
