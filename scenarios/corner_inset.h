#pragma once

#include "esi/config.h"

namespace nightjar::scenarios {

/// By how much the tag's black square looks too small on each side in a method's pictures, in
/// pixels; below 0 it looks too large. Stands for tracker.measurement.corner_inset_px where a
/// scenario file does not say it. Measured for esi and esi_net (docs/decisions/0009); htac's
/// is esi's, and so, unmeasured, is that of the others.
double corner_inset_px(esi::Method method);

}  // namespace nightjar::scenarios
