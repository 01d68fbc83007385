#pragma once

#include <string>

#include "camera/caer_config.h"
#include "camera/mount_config.h"

namespace nightjar::camera {

enum class SourceType { simulation, caer };

inline constexpr core::Choices<SourceType, 2> kSourceTypes{
    {{"simulation", SourceType::simulation}, {"caer", SourceType::caer}}};

/// Where events, frames and IMU samples come from: the simulator, or a camera through
/// libcaer.
struct SourceConfig {
  SourceType type = SourceType::simulation;
  /// A real camera's, a file that `nightjar calibrate` wrote; in a scenario file relative to
  /// that file. Empty: the pinhole that the scenario's section camera describes.
  std::string intrinsics;
  MountConfig mount;  ///< Of a real camera; the simulator's is its model's.
  CaerConfig caer;

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("type", type, kSourceTypes);
    v.field("intrinsics", intrinsics);
    v.section("mount", mount);
    v.section("caer", caer);
  }
};

}  // namespace nightjar::camera
