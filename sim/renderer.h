#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "sim/gray_materials.h"
#include "sim/off_screen.h"
#include "sim/scene.h"
#include "sim/view.h"

namespace nightjar::sim {

/// Draws what the sensor sees of a scene, off-screen with MuJoCo on OSMesa: luminance alone,
/// shaded and filtered in float, kept with 16 bits (docs/decisions/0002).
class Renderer {
 public:
  /// Radiance is linear up to here, in units of a white surface's; brighter is cut off.
  static constexpr double kBrightest = 2.0;

  /// `size`: of the sensor; every pixel is the mean of supersampling^2 samples.
  /// Throws std::runtime_error as OffScreen does, std::invalid_argument for lights that add
  /// up to more than kBrightest or are not grey.
  Renderer(Scene& scene, core::Resolution size, int supersampling);

  /// What draws, as OpenGL names it.
  const std::string& description() const { return off_screen_.description(); }

  /// Luminance (Rec. 709 weights) in lux, `white_lux` being a white surface under light of 1
  /// in the scene's units. From any thread, one at a time.
  void draw(const View& view, double white_lux, core::Image<float>& luminance_lux);

  /// Looks and draws.
  void draw(Scene& scene, int camera, double white_lux, core::Image<float>& luminance_lux);

 private:
  core::Resolution size_;
  int supersampling_;
  OffScreen off_screen_;
  GrayMaterials materials_;
  View view_;
  std::vector<std::uint16_t> codes_;  ///< As drawn: the bottom row first.
};

}  // namespace nightjar::sim
