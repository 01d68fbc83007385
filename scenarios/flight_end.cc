#include "scenarios/flight_end.h"

#include "msg/channels.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kAfterTouchdown = 500ms;

}  // namespace

FlightEnd::FlightEnd(msg::Bus& bus, double duration_s) : end_(core::from_seconds(duration_s)) {
  bus.subscribe(msg::kMissionTransition, [this](const core::MissionTransition& transition) {
    if (transition.to == core::MissionPhase::touched_down) touched_down_ = transition.t;
  });
}

bool FlightEnd::reached(const core::Truth& truth) const {
  return truth.t >= end_ || truth.crashed ||
         (touched_down_ && truth.t >= *touched_down_ + kAfterTouchdown);
}

}  // namespace nightjar::scenarios
