#pragma once

#include <vector>

#include "core/state.h"

namespace nightjar::msg {

/// Every tag decoded in the picture made at `t`; each tag's own time is `t` too.
struct TagDetections {
  core::Time t{};
  std::vector<core::TagDetection> tags;
};

}  // namespace nightjar::msg
