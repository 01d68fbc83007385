#pragma once

#include <memory>
#include <optional>
#include <span>

#include "esi/config.h"
#include "esi/reconstructor.h"
#include "scenarios/method_scores.h"
#include "scenarios/network_steps.h"
#include "scenarios/reconstructor_feed.h"

namespace nightjar::scenarios {

/// One method on its way through a recording, compared with frames as it goes. One that
/// cannot run (lacks_weights()) takes everything and does nothing.
class ScoredMethod {
 public:
  /// Throws std::invalid_argument as esi::make_any_reconstructor() does.
  ScoredMethod(const esi::ReconstructorConfig& config, core::Resolution size);

  /// Begins at the recording's first event.
  void begin(core::Time t);

  /// A frame that acts once its exposure has ended; nothing to methods without use for it.
  void add_frame(const core::ApsFrame& frame);

  /// The next events. A network ends its steps as `steps` says, which cover these events.
  void take_events(std::span<const core::Event> events, const NetworkSteps& steps);

  /// All events up to `t` have been taken: frames that end by then act now.
  void advance_to(core::Time t);

  /// Compares the picture at `t`.
  void compare(core::Time t, const core::Image<std::uint8_t>& reference);

  /// What came of it.
  MethodScore result() const;

 private:
  void take_network_events(std::span<const core::Event> events, const NetworkSteps& steps);

  esi::ReconstructorConfig config_;
  MethodScore result_;
  std::unique_ptr<esi::Reconstructor> reconstructor_;  ///< None: it is skipped.
  std::optional<ReconstructorFeed> feed_;
  std::optional<core::Time> step_end_;  ///< Of a network's step that has begun.
  core::Picture picture_;
};

}  // namespace nightjar::scenarios
