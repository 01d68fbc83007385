#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/event.h"
#include "core/image.h"
#include "core/random.h"

namespace nightjar::test {

/// A plane of random grey tiles with soft edges, seen by a camera that goes round in
/// circles and rolls: every pixel moves by about half a pixel a step, and after
/// `kSteps` steps the picture is the first one again.
class MovingTexture {
 public:
  static constexpr int kSteps = 128;

  explicit MovingTexture(double white_lux, std::uint64_t seed = 1) : white_lux_(white_lux) {
    core::Random random = core::random_stream(seed, "texture");
    for (double& reflectance : tiles_)
      // From 3 % to 90 % in the logarithm, as black and white of a printed tag.
      reflectance = 0.03 * std::pow(30.0, core::uniform01(random));
  }

  core::Image<float> luminance_lux(core::Resolution size, int step) const {
    core::Image<float> image(size);
    const double phase = 2 * std::numbers::pi * step / kSteps;
    const double roll = 0.05 * std::sin(phase);
    const double cos = std::cos(roll), sin = std::sin(roll);
    for (int y = 0; y < size.height_px; ++y)
      for (int x = 0; x < size.width_px; ++x) {
        const double u = x - size.width_px / 2.0, v = y - size.height_px / 2.0;
        const double radius_px = 0.5 * kSteps / (2 * std::numbers::pi);
        image(x, y) = static_cast<float>(
            white_lux_ * reflectance(cos * u - sin * v + radius_px * std::cos(phase) + 1000,
                                     sin * u + cos * v + radius_px * std::sin(phase) + 1000));
      }
    return image;
  }

 private:
  static constexpr double kTilePx = 120;
  static constexpr int kTiles = 16;

  /// From 0 to 1 over two pixels about the edge at 0.
  static double soft(double distance_px) {
    const double f = std::clamp(0.5 + distance_px / 2, 0.0, 1.0);
    return f * f * (3 - 2 * f);
  }

  double tile(int i, int k) const { return tiles_[(i % kTiles) * kTiles + k % kTiles]; }

  double reflectance(double x_px, double y_px) const {
    const int i = static_cast<int>(x_px / kTilePx), k = static_cast<int>(y_px / kTilePx);
    const double f = soft(x_px - (i + 0.5) * kTilePx), g = soft(y_px - (k + 0.5) * kTilePx);
    const double top = tile(i, k) * (1 - f) + tile(i + 1, k) * f;
    const double bottom = tile(i, k + 1) * (1 - f) + tile(i + 1, k + 1) * f;
    // A little shading, so that no pixel is quite still.
    return (top * (1 - g) + bottom * g) * (1 + 0.03 * std::sin(x_px / 9) * std::sin(y_px / 11));
  }

  double white_lux_;
  double tiles_[kTiles * kTiles];
};

}  // namespace nightjar::test
