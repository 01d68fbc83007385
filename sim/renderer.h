#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/image.h"
#include "sim/scene.h"

namespace nightjar::sim {

/// Red, green, blue, 8 bits each; for people, never for the sensor.
using Rgb = std::array<std::uint8_t, 3>;

/// Draws a scene off-screen with MuJoCo on OSMesa: shaded and filtered in float, kept
/// with 16 bits a channel (docs/decisions/0002).
///
/// Mesa reads its settings from the environment before the first context of a process:
/// the first Renderer sets GALLIVM_PERF, and LP_NUM_THREADS where it is not set.
class Renderer {
 public:
  /// The geom group that the sensor is shown.
  static constexpr int kSensorGroup = 0;
  /// Radiance is linear up to here, in units of a white surface's; brighter is cut off.
  static constexpr double kBrightest = 2.0;

  /// `size`: of the sensor; every pixel is the mean of supersampling^2 samples.
  /// Throws std::runtime_error when OSMesa is missing something, cannot draw with 16 bits
  /// or is not llvmpipe (Mesa's other software renderer is some sixty times slower),
  /// std::invalid_argument for lights that add up to more than kBrightest.
  Renderer(Scene& scene, core::Resolution size, int supersampling);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// What draws, as OpenGL names it.
  const std::string& description() const { return description_; }

  /// What the fixed `camera` sees of kSensorGroup: luminance (Rec. 709 weights) in lux,
  /// `white_lux` being a white surface under light of 1 in the scene's units.
  void draw(Scene& scene, int camera, double white_lux, core::Image<float>& luminance_lux);

  /// A colour view for people of what lies around `look_at_m`, all groups that are
  /// ever drawn, from `distance_m` away. Angles in degrees, MuJoCo's free camera.
  void draw_view(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
                 double azimuth_deg, double elevation_deg, core::Image<Rgb>& view);

 private:
  struct Gl;
  void check_llvmpipe();
  void check_lights(Scene& scene);

  std::unique_ptr<Gl> gl_;
  core::Resolution size_;
  int supersampling_;
  std::string description_;
};

}  // namespace nightjar::sim
