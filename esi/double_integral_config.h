#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

/// Event-based double integral (EDI: Pan et al., CVPR 2019) and its fast form (FEDI: Lin et
/// al., 2023), which share their model and so their parameters.
struct DoubleIntegralConfig {
  double contrast_log = 0.2;    ///< c before the first frame, and where it is not searched for.
  bool search_contrast = true;  ///< Choose c anew for each frame, by the picture's sharpness.
  double search_least_log = 0.05;
  double search_greatest_log = 0.5;
  /// Events kept for a frame whose exposure is still to come; see also
  /// DoubleIntegral::kMostKept.
  double history_s = 2.0;

  template <class Visitor>
  void visit(Visitor& v) {
    const core::Origin ours{"assumption: a DAVIS346's range of thresholds"};
    v.field("contrast_log", contrast_log, 0.001, 2.0, ours);
    v.field("search_contrast", search_contrast);
    v.field("search_least_log", search_least_log, 0.001, 2.0, ours);
    v.field("search_greatest_log", search_greatest_log, 0.001, 2.0, ours);
    v.field("history_s", history_s, 0.01, 60.0,
            core::Origin{"assumption: four exposures of 0.5 s, the ESI paper's longest"});
  }
};

}  // namespace nightjar::esi
