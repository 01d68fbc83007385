#pragma once

#include <optional>

#include "core/truth.h"
#include "msg/bus.h"

namespace nightjar::scenarios {

/// Tells when a flight is over: half a second after touchdown, with a crash, or when its
/// time is up. Listens to the mission's steps within Bus::dispatch().
class FlightEnd {
 public:
  FlightEnd(msg::Bus& bus, double duration_s);

  bool reached(const core::Truth& truth) const;

 private:
  core::Time end_;
  std::optional<core::Time> touched_down_;
};

}  // namespace nightjar::scenarios
