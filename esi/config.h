#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

/// Event-based single integration (ESI paper, section III). The paper gives no
/// values; these were tuned on seeds 101 to 104 of scenarios/tracking_landing.yaml.
struct EsiConfig {
  double contrast_log = 0.15;  ///< C: step per event, natural log units.
  double decay_rate_hz = 1.0;  ///< k: an event 1/k after its predecessor wipes the pixel.
  double decay_power = 1.0;    ///< b.
  double least_log = -1.0;     ///< Smin, black.
  double greatest_log = 1.0;   ///< Smax, white.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("contrast_log", contrast_log, 0.001, 2.0);
    v.field("decay_rate_hz", decay_rate_hz, 0.0, 1000.0);
    v.field("decay_power", decay_power, 0.01, 20.0);
    v.field("least_log", least_log, -100.0, 0.0);
    v.field("greatest_log", greatest_log, 0.001, 100.0);
  }
};

}  // namespace nightjar::esi
