#pragma once

#include <memory>

#include "esi/config.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Whether the method is a network, which make_network() of the library esi_networks
/// builds: it needs OpenCV, this library does not.
bool is_network(Method method);

/// Builds config.method for a sensor of this size. Throws std::invalid_argument for a
/// config out of range, naming field, value and range, and for a network.
std::unique_ptr<Reconstructor> make_reconstructor(const ReconstructorConfig& config,
                                                  core::Resolution size);

}  // namespace nightjar::esi
