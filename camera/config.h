#pragma once

#include "camera/caer_config.h"

namespace nightjar::camera {

enum class SourceType { simulation, caer };

inline constexpr core::Choices<SourceType, 2> kSourceTypes{
    {{"simulation", SourceType::simulation}, {"caer", SourceType::caer}}};

/// Where events, frames and IMU samples come from: the simulator, or a camera through
/// libcaer.
struct SourceConfig {
  SourceType type = SourceType::simulation;
  CaerConfig caer;

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("type", type, kSourceTypes);
    v.section("caer", caer);
  }
};

}  // namespace nightjar::camera
