#include "tracker/state_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace nightjar::tracker {

core::VehicleState extrapolate(const core::VehicleState& state, double dt_s) {
  core::VehicleState next = state;
  next.t = state.t + core::from_seconds(dt_s);
  next.p_world_body_m += state.v_world_body_m_s * dt_s;
  const double rate_rad_s = state.omega_body_rad_s.norm();
  if (rate_rad_s > 0)
    next.q_world_body = state.q_world_body *
                        Eigen::AngleAxisd(rate_rad_s * dt_s, state.omega_body_rad_s / rate_rad_s);
  return next;
}

void StateHistory::add(const core::VehicleState& state) {
  if (!states_.empty() && state.t <= states_.back().t)
    throw std::invalid_argument(fmt::format("vehicle state at {} us, allowed later than {} us",
                                            state.t.count(), states_.back().t.count()));
  states_.push_back(state);
  while (states_.front().t < state.t - span_) states_.pop_front();
}

std::optional<core::VehicleState> StateHistory::at(core::Time t) const {
  if (states_.empty() || t < states_.front().t || t > states_.back().t + most_ahead_)
    return std::nullopt;
  const auto after = std::lower_bound(
      states_.begin(), states_.end(), t,
      [](const core::VehicleState& state, core::Time time) { return state.t < time; });
  if (after == states_.end())
    return extrapolate(states_.back(), core::seconds(t - states_.back().t));
  if (after->t == t) return *after;

  const core::VehicleState& a = *std::prev(after);
  const core::VehicleState& b = *after;
  const double u = core::seconds(t - a.t) / core::seconds(b.t - a.t);
  return core::VehicleState{
      .t = t,
      .p_world_body_m = (1 - u) * a.p_world_body_m + u * b.p_world_body_m,
      .v_world_body_m_s = (1 - u) * a.v_world_body_m_s + u * b.v_world_body_m_s,
      .q_world_body = a.q_world_body.slerp(u, b.q_world_body),
      .omega_body_rad_s = (1 - u) * a.omega_body_rad_s + u * b.omega_body_rad_s};
}

}  // namespace nightjar::tracker
