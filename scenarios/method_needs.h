#pragma once

#include <string>

#include "esi/config.h"

namespace nightjar::scenarios {

/// Why config.method cannot be scored: a network without weights. Else empty.
std::string lacks_weights(const esi::ReconstructorConfig& config);

/// Of a method whose pictures say little before its first frame: EDI and FEDI.
bool starts_from_frames(esi::Method method);

/// Whether config.method makes its pictures of frames, too, where there are any.
bool is_given_frames(const esi::ReconstructorConfig& config);

}  // namespace nightjar::scenarios
