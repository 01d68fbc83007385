#pragma once

#include <memory>

#include "core/image.h"
#include "core/stage_timer.h"
#include "esi/config.h"
#include "esi/reconstructor.h"
#include "msg/bus.h"
#include "scenarios/reconstructor_feed.h"

namespace nightjar::scenarios {

/// Event packets and frames of the active pixels in, a picture at the end of each packet
/// out; the first packet begins with an empty one. A frame acts with the packet that its exposure
/// ends in, or the next after it came. Acts within Bus::dispatch() and knows neither who sends nor
/// who listens.
class ReconstructionNode {
 public:
  /// Throws std::invalid_argument as esi::make_any_reconstructor() does.
  ReconstructionNode(msg::Bus& bus, const esi::ReconstructorConfig& config, core::Resolution size);

  const core::StageTime& stage_time() const { return reconstructing_.time(); }

 private:
  std::unique_ptr<esi::Reconstructor> reconstructor_;
  ReconstructorFeed feed_;
  core::Picture picture_;
  bool begun_ = false;
  core::StageTimer reconstructing_{"reconstruct", "loop"};
};

}  // namespace nightjar::scenarios
