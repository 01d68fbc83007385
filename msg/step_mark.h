#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/event.h"

namespace nightjar::msg {

/// Closes what one process sent for one event packet (msg/step_t.lcm).
struct StepMark {
  /// How many messages on a channel.
  struct Sent {
    std::string channel;
    std::int32_t messages = 0;

    friend bool operator==(const Sent&, const Sent&) = default;
  };

  core::Time t{};             ///< End of the packet.
  std::int64_t run = 0;       ///< The same in all that follows from one run of a source.
  std::int64_t sequence = 0;  ///< Counts the sender's steps of the run from 0.
  core::Time origin{};        ///< When the source had the packet: core::Time of its steady clock.
  bool lock_step = false;     ///< The step is sent again until it is answered.
  std::vector<Sent> sent;
  std::string sender;  ///< source, reconstruction, tracker

  friend bool operator==(const StepMark&, const StepMark&) = default;
};

}  // namespace nightjar::msg
