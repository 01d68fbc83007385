#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

/// High-throughput asynchronous convolutions (De et al., 2022): no public code was found,
/// so these defaults are ours.
struct HtacConfig {
  double contrast_log = 0.2;  ///< Sum of an event's weights, natural log units.
  double decay_time_s = 1.0;  ///< To 1/e.
  double sigma_px = 0.7;      ///< Of the Gaussian kernel around an event, 3x3; 0 = the pixel alone.
  double least_log = -1.0;    ///< Black.
  double greatest_log = 1.0;  ///< White.

  template <class Visitor>
  void visit(Visitor& v) {
    const core::Origin ours{"assumption: as the esi method"};
    v.field("contrast_log", contrast_log, 0.001, 2.0, ours);
    v.field("decay_time_s", decay_time_s, 0.0001, 1000.0, ours);
    v.field("sigma_px", sigma_px, 0.0, 3.0,
            core::Origin{"assumption: two thirds of the weight beside the middle"});
    v.field("least_log", least_log, -100.0, 0.0, ours);
    v.field("greatest_log", greatest_log, 0.001, 100.0, ours);
  }
};

}  // namespace nightjar::esi
