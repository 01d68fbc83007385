#include "esi/event_history.h"

namespace nightjar::esi {

void EventHistory::append(std::span<const PackedEvent> events) {
  if (events.empty()) return;
  buffer_.insert(buffer_.end(), events.begin(), events.end());
  drop_older(buffer_.back().t_us, most_age_us_);
  const std::size_t kept = buffer_.size() - begin_;
  if (kept > most_events_) {
    dropped_ += kept - most_events_;
    drop_first(kept - most_events_);
  }
}

void EventHistory::drop_first(std::size_t count) {
  begin_ += count;
  if (2 * begin_ < buffer_.size()) return;  // so each event is moved once at most, on average
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
}

void EventHistory::drop_older(std::uint32_t now_us, std::uint32_t age_us) {
  std::size_t count = 0;
  for (const PackedEvent& e : events()) {
    if (now_us - e.t_us <= age_us) break;
    ++count;
  }
  drop_first(count);
}

void EventHistory::clear() {
  buffer_.clear();
  begin_ = 0;
  dropped_ = 0;
}

}  // namespace nightjar::esi
