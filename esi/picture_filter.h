#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "esi/complementary_filter_config.h"

namespace nightjar::esi {

/// A 5x5 filter of 8-bit pictures; beyond its edges a picture goes on mirrored, the pixels on
/// the edge not repeated. As OpenCV's GaussianBlur and bilateralFilter with d = 5.
class PictureFilter {
 public:
  /// `sigma` > 0 as ComplementaryFilterConfig::filter_sigma.
  PictureFilter(SpatialFilter kind, double sigma);

  /// Filters in place. Pictures of one size are filtered without allocation after the first.
  void apply(core::Image<std::uint8_t>& gray);

 private:
  static constexpr int kReach_px = 2;
  /// Of a bilateral filter: those not further than kReach_px from the middle.
  struct Tap {
    int dx;
    int dy;
    float weight;
  };

  void pad(const core::Image<std::uint8_t>& gray);
  void blur(core::Image<std::uint8_t>& gray);
  void smooth_but_edges(core::Image<std::uint8_t>& gray) const;

  SpatialFilter kind_;
  std::array<float, 2 * kReach_px + 1> gaussian_{};
  std::vector<Tap> taps_;
  std::array<float, 256> of_difference_{};  ///< Weight of a grey level that far off.
  core::Image<std::uint8_t> padded_;        ///< kReach_px more on each side.
  core::Image<float> rows_;                 ///< Filtered along the rows, as high as padded_.
};

}  // namespace nightjar::esi
