#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/image_motion.h"
#include "sim/scene.h"

namespace nightjar::sim {

/// How fast what a scene's sensor camera sees can move across its picture.
class ViewMotion {
 public:
  /// Looks at the geoms that the sensor is shown (View::look), as they are now.
  explicit ViewMotion(const Scene& scene);

  /// An upper bound (px/s) for all of them at this moment.
  double fastest_px_s(const Scene& scene, const core::CameraModel& model,
                      const MovingCamera& camera) const;

 private:
  struct Part {
    int geom;
    int body;
    Eigen::Vector3d half_size_m;   ///< Of a box around it.
    Eigen::Vector3d visible_turn;  ///< 1 for each own axis about which turning shows, else 0.
  };
  std::vector<Part> parts_;
};

}  // namespace nightjar::sim
