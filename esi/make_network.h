#pragma once

#include <memory>

#include "esi/config.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Builds any method for a sensor of this size: the networks with OpenCV, the others as
/// make_reconstructor() does. Throws std::invalid_argument for a config out of range and,
/// of a network, where RecurrentNetwork does.
std::unique_ptr<Reconstructor> make_any_reconstructor(const ReconstructorConfig& config,
                                                      core::Resolution size);

}  // namespace nightjar::esi
