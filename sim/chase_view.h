#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "sim/off_screen.h"
#include "sim/view.h"

namespace nightjar::sim {

/// Red, green, blue, 8 bits each; for people, never for the sensor.
using Rgb = std::array<std::uint8_t, 3>;

/// Draws a scene in colour, as people see it.
class ChaseView {
 public:
  /// Throws std::runtime_error as OffScreen does.
  ChaseView(const Scene& scene, core::Resolution size);

  core::Resolution size() const { return off_screen_.size(); }

  /// What View::look_at sees. From any thread, one at a time.
  void draw(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
            double azimuth_deg, double elevation_deg, core::Image<Rgb>& picture);

 private:
  OffScreen off_screen_;
  View view_;
  std::vector<Rgb> rows_;  ///< As drawn: the bottom one first.
};

}  // namespace nightjar::sim
