#pragma once

#include "esi/config.h"

namespace nightjar::scenarios {

/// By how much the tag's black square looks too small on each side in a method's pictures, in
/// pixels; below 0 it looks too large. Stands for tracker.measurement.corner_inset_px where a
/// scenario file does not say it. Measured in flight for esi and over the trial's motions for
/// esi_net; the others have esi's, which is htac's, too, though the accumulator's is nearer 0.2 and
/// that of EDI and FEDI nearer 0.1, which find too few tags to fly by (docs/decisions/0009).
double corner_inset_px(esi::Method method);

}  // namespace nightjar::scenarios
