#include "esi/make_reconstructor.h"

#include <stdexcept>

#include "esi/accumulator.h"
#include "esi/complementary_filter.h"
#include "esi/edi.h"
#include "esi/esi.h"
#include "esi/esi_net.h"
#include "esi/fedi.h"
#include "esi/htac.h"

namespace nightjar::esi {

bool is_network(Method method) { return method == Method::firenet || method == Method::e2vid; }

std::unique_ptr<Reconstructor> make_reconstructor(const ReconstructorConfig& config,
                                                  core::Resolution size) {
  switch (config.method) {
    case Method::esi_net:
      return std::make_unique<EsiNet>(config.esi_net, size);
    case Method::esi: return std::make_unique<Esi>(config.esi, size);
    case Method::accumulator: return std::make_unique<Accumulator>(config.accumulator, size);
    case Method::complementary_filter:
      return std::make_unique<ComplementaryFilter>(config.complementary_filter, size);
    case Method::edi: return std::make_unique<Edi>(config.edi, size);
    case Method::fedi: return std::make_unique<Fedi>(config.fedi, size);
    case Method::htac: return std::make_unique<Htac>(config.htac, size);
    default: throw std::invalid_argument("reconstructor.method: not built yet");
  }
}

}  // namespace nightjar::esi
