#pragma once

#include <array>
#include <map>

struct mjrContext_;
struct mjvScene_;

namespace nightjar::sim {

/// Gives geoms the luminance (Rec. 709 weights) of their colours and textures, for a sensor
/// that knows no colours: with grey light a texture times its material's colour times light
/// then has the luminance of the coloured product, in one channel instead of three
/// (docs/decisions/0002).
class GrayMaterials {
 public:
  /// Turns all geoms grey; what textures that takes is added to `resources`, whose context is
  /// current. Throws std::runtime_error when they do not fit.
  void apply(mjrContext_& resources, mjvScene_& geoms);

 private:
  /// A texture of the model's and the colour it is multiplied by.
  struct Material {
    int texture;
    std::array<float, 3> rgb;
    auto operator<=>(const Material&) const = default;
  };
  std::map<Material, int> gray_;  ///< Numbers of textures in the resources.
};

}  // namespace nightjar::sim
