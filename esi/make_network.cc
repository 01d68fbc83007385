#include "esi/make_network.h"

#include "esi/make_reconstructor.h"
#include "esi/recurrent_network.h"

namespace nightjar::esi {

std::unique_ptr<Reconstructor> make_any_reconstructor(const ReconstructorConfig& config,
                                                      core::Resolution size) {
  switch (config.method) {
    case Method::firenet:
      return std::make_unique<RecurrentNetwork>("firenet", config.firenet, size);
    case Method::e2vid: return std::make_unique<RecurrentNetwork>("e2vid", config.e2vid, size);
    default: return make_reconstructor(config, size);
  }
}

}  // namespace nightjar::esi
