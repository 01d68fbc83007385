#pragma once

#include "core/image.h"
#include "esi/esi.h"
#include "msg/bus.h"

namespace nightjar::scenarios {

/// Event packets in, a picture at the end of each out.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class ReconstructionNode {
 public:
  ReconstructionNode(msg::Bus& bus, const esi::EsiConfig& config, core::Resolution size);

 private:
  esi::Esi esi_;
  core::Picture picture_;
};

}  // namespace nightjar::scenarios
