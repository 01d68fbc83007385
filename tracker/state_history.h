#pragma once

#include <deque>
#include <optional>

#include "core/state.h"

namespace nightjar::tracker {

/// The autopilot's states of the last while, for asking what was at a time
/// between two of them.
class StateHistory {
 public:
  /// Keeps states up to `span` older than the newest, and moves that on by `most_ahead`.
  StateHistory(core::Time span, core::Time most_ahead) : span_(span), most_ahead_(most_ahead) {}

  /// Takes the next state; throws std::invalid_argument if it is not newer
  /// than the last one.
  void add(const core::VehicleState& state);

  /// The state at `t`: interpolated (positions linearly, attitude along the
  /// great circle); after the newest extrapolated at its velocity and body
  /// rate, no further than `most_ahead`. Nothing before the oldest or when there is none.
  std::optional<core::VehicleState> at(core::Time t) const;

 private:
  core::Time span_;
  core::Time most_ahead_;
  std::deque<core::VehicleState> states_;
};

/// `state` moved on by `dt_s` at its velocity and body rate.
core::VehicleState extrapolate(const core::VehicleState& state, double dt_s);

}  // namespace nightjar::tracker
