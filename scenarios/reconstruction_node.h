#pragma once

#include "core/image.h"
#include "core/stage_timer.h"
#include "esi/esi.h"
#include "msg/bus.h"

namespace nightjar::scenarios {

/// Event packets in, a picture at the end of each out.
/// Acts within Bus::dispatch() and knows neither who sends nor who listens.
class ReconstructionNode {
 public:
  ReconstructionNode(msg::Bus& bus, const esi::EsiConfig& config, core::Resolution size);

  const core::StageTime& stage_time() const { return reconstructing_.time(); }

 private:
  esi::Esi esi_;
  core::Picture picture_;
  core::StageTimer reconstructing_{"reconstruct", "handling"};
};

}  // namespace nightjar::scenarios
