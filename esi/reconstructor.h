#pragma once

#include <span>

#include "core/event.h"
#include "core/image.h"

namespace nightjar::esi {

/// Turns events into 8-bit pictures. The picture depends on the events, never on
/// where the stream was cut into batches (tests/esi/reconstructor_contract_test.cc).
class Reconstructor {
 public:
  virtual ~Reconstructor() = default;

  /// Takes the next events, ordered by time and none older than those before.
  /// Virtual once per batch; the loop over events is inside each variant.
  /// Throws std::invalid_argument for an event outside the sensor or older than its
  /// predecessor; the events before it have then been taken.
  virtual void process(std::span<const core::Event> events) = 0;

  /// The picture at `t`, not before the last event.
  virtual void render(core::Time t, core::Picture& picture) = 0;

  /// Returns to the state after construction.
  virtual void reset() = 0;
};

}  // namespace nightjar::esi
