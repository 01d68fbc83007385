#include "sim/readout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace nightjar::sim {
namespace {

constexpr std::int64_t kPicosecondsPerMicrosecond = 1'000'000;

std::int64_t picoseconds(core::Time t) { return t.count() * kPicosecondsPerMicrosecond; }

}  // namespace

Readout::Readout(const ReadoutConfig& config, core::Resolution size)
    : config_(config), size_(size), rows_(static_cast<std::size_t>(std::max(0, size.height_px))) {
  core::check_config(config, "readout");
  service_ps_ = std::llround(1e12 / config.max_event_rate_hz);
}

void Readout::check(core::Time until, std::span<const core::Event> requests) const {
  core::Time last = until_;
  for (const core::Event& request : requests) {
    if (request.t < last || request.t > until)
      throw std::invalid_argument(fmt::format("request at {} us, allowed {} to {}",
                                              request.t.count(), last.count(), until.count()));
    if (request.x >= size_.width_px || request.y >= size_.height_px)
      throw std::invalid_argument(fmt::format("request at pixel ({}, {}) of {}x{}", request.x,
                                              request.y, size_.width_px, size_.height_px));
    last = request.t;
  }
}

void Readout::step(core::Time until, std::span<const core::Event> requests,
                   std::vector<core::Event>& events) {
  check(until, requests);
  until_ = until;
  const std::int64_t end_ps = picoseconds(until) + kPicosecondsPerMicrosecond;
  for (;;) {
    if (waiting_ == 0) {
      if (requests.empty()) break;
      free_ps_ = std::max(free_ps_, picoseconds(requests.front().t));
    }
    admit(requests);
    if (free_ps_ >= end_ps) break;

    std::deque<core::Event>& row = rows_[asking_rows_.front()];
    if (turn_left_ == 0) turn_left_ = static_cast<int>(row.size());
    core::Event event = row.front();
    row.pop_front();
    const core::Time stamp(free_ps_ / kPicosecondsPerMicrosecond);
    counts_.max_delay = std::max(counts_.max_delay, stamp - event.t);
    event.t = stamp;
    events.push_back(event);
    ++counts_.read;
    --waiting_;
    free_ps_ += service_ps_;
    if (--turn_left_ > 0) continue;
    // Whoever asked during the row's turn asks anew, behind the other rows.
    if (!row.empty()) asking_rows_.push_back(asking_rows_.front());
    asking_rows_.pop_front();
  }
}

void Readout::admit(std::span<const core::Event>& requests) {
  while (!requests.empty() && picoseconds(requests.front().t) <= free_ps_) {
    const core::Event& request = requests.front();
    requests = requests.subspan(1);
    if (waiting_ >= config_.queue_capacity_events) {
      ++counts_.lost;
      continue;
    }
    std::deque<core::Event>& row = rows_[request.y];
    if (row.empty()) asking_rows_.push_back(request.y);
    row.push_back(request);
    ++waiting_;
  }
}

}  // namespace nightjar::sim
