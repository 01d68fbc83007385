#include "scenarios/event_stream.h"

#include <algorithm>

namespace nightjar::scenarios {

std::optional<core::Time> EventStream::next_time() {
  if (!fill()) return std::nullopt;
  return left_.front().t;
}

std::span<const core::Event> EventStream::take_until(core::Time t) {
  if (!fill()) return {};
  const auto later = std::ranges::upper_bound(left_, t, {}, &core::Event::t);
  const auto taken = left_.first(static_cast<std::size_t>(later - left_.begin()));
  left_ = left_.subspan(taken.size());
  return taken;
}

/// Whether there is an event left.
bool EventStream::fill() {
  while (left_.empty()) {
    if (!recording_.next(part_)) return false;
    left_ = part_.events;
    if (left_.empty()) continue;
    if (!begin_) begin_ = left_.front().t;
    estimated_duration_s_ =
        core::seconds(left_.back().t - *begin_) / std::max(recording_.progress(), 1e-6);
  }
  return true;
}

}  // namespace nightjar::scenarios
