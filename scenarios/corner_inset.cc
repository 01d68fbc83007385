#include "scenarios/corner_inset.h"

#include "tracker/config.h"

namespace nightjar::scenarios {

double corner_inset_px(esi::Method method) {
  if (method == esi::Method::esi_net) return 0;  // -0.05 to 0.13 measured
  return tracker::MeasurementConfig{}.corner_inset_px;
}

}  // namespace nightjar::scenarios
