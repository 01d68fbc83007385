#pragma once

#include <array>
#include <memory>

#include "sim/scene.h"

struct mjvScene_;

namespace nightjar::sim {

/// What there is to be drawn of a scene at one moment: a copy, so that the scene may move
/// on while it is drawn.
class View {
 public:
  /// The geom group that the sensor is shown; the UAV itself is in another.
  static constexpr int kSensorGroup = 0;

  /// Of `scene`, and of any with the same model. Sees nothing yet.
  explicit View(const Scene& scene);

  /// What the fixed `camera` sees, or saw `ago_s` earlier (Scene::moment()), of kSensorGroup.
  void look(Scene& scene, int camera, double ago_s = 0);

  /// What lies around `look_at_m`, all groups that are ever drawn, from `distance_m` away.
  /// Angles in degrees, MuJoCo's free camera.
  void look_at(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
               double azimuth_deg, double elevation_deg);

  const mjvScene_& geoms() const { return *geoms_; }

 private:
  struct Delete {
    void operator()(mjvScene_*) const;
  };
  std::unique_ptr<mjvScene_, Delete> geoms_;
};

}  // namespace nightjar::sim
