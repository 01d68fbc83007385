#pragma once

#include <string>

#include "core/config_check.h"

namespace nightjar::esi {

/// A recurrent network that reads a voxel grid of events (E2VID: Rebecq et al. 2019;
/// FireNet: Scheerlinck et al. 2020). The weights are the user's own.
struct NetworkConfig {
  std::string weights;    ///< An ONNX file.
  bool normalise = true;  ///< Voxels that are not zero to mean 0 and deviation 1; FireNet+: no.
  bool stretch = true;    ///< The picture from its 1 % to its 99 % quantile, else from 0 to 1.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("weights", weights);
    v.field("normalise", normalise);
    v.field("stretch", stretch);
  }
};

}  // namespace nightjar::esi
