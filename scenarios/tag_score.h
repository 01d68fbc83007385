#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/camera_model.h"
#include "core/state.h"
#include "core/truth.h"
#include "scenarios/tag_config.h"

namespace nightjar::scenarios {

/// Where the corners of the tag's black square (`tag_size_m` a side) are in the
/// picture, in core::TagDetection's order; nothing when one is not in front of
/// the camera. Tag axes: origin in the centre, x towards the tag's top edge, y
/// to its left, z out of its face.
std::optional<std::array<Eigen::Vector2d, 4>> project_tag(const core::CameraModel& camera,
                                                          const core::Truth& truth,
                                                          double tag_size_m);

/// How the tags decoded in one picture compare with the truth.
struct TagScore {
  bool detected = false;     ///< the printed tag was found, every corner within 5 px
  int false_detections = 0;  ///< everything else decoded, a second such tag among it
};

TagScore score_tags(const core::CameraModel& camera, const core::Truth& truth,
                    const TagConfig& printed, std::span<const core::TagDetection> detections);

}  // namespace nightjar::scenarios
