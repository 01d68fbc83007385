#include "sim/readout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

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
  for (;;) {
    if (waiting_ == 0) {
      read_in_order(requests, events);
      if (requests.empty()) break;
      free_ps_ = std::max(free_ps_, picoseconds(requests.front().t));
    }
    const core::Time now(free_ps_ / kPicosecondsPerMicrosecond);
    admit(now, requests);
    if (now > until) break;
    const core::Event& request = take_next();
    counts_.max_delay = std::max(counts_.max_delay, now - request.t);
    events.push_back({now, request.x, request.y, request.on});
    ++counts_.read;
    free_ps_ += service_ps_;
  }
}

void Readout::read_in_order(std::span<const core::Event>& requests,
                            std::vector<core::Event>& events) {
  // No more than the queue holds, so that none can be lost.
  constexpr int kMost = 256;
  const std::size_t most =
      std::min<std::size_t>(requests.size(), std::min(kMost, config_.queue_capacity_events));
  core::Event read[kMost];
  // When the last one's turn began, and when the arbiter found all that have theirs with it.
  std::int64_t now_us = INT64_MIN / 2, found_us = 0;
  int y = 0;
  std::size_t k = 0;
  for (; k < most; ++k) {
    const core::Event& request = requests[k];
    const std::int64_t t_us = request.t.count();
    // All bits or none: nobody can guess these, so that there is no branch for them.
    const std::int64_t found_alone = (now_us - t_us) >> 63;
    const std::int64_t has_to_queue = ((found_us - t_us) | (request.y - y)) >> 63;
    if ((has_to_queue & ~found_alone) != 0) break;
    const std::int64_t at_ps = std::max(free_ps_, picoseconds(request.t));
    now_us = at_ps / kPicosecondsPerMicrosecond;
    if (now_us > until_.count()) break;
    found_us += (now_us - found_us) & found_alone;
    y = request.y;
    read[k] = {core::Time(now_us), request.x, request.y, request.on};
    free_ps_ = at_ps + service_ps_;
  }
  if (k < requests.size())  // those found together have to queue if one of them has to
    for (; k > 0 && requests[k].t <= read[k - 1].t; --k) free_ps_ -= service_ps_;
  for (std::size_t i = 0; i < k; ++i)
    counts_.max_delay = std::max(counts_.max_delay, read[i].t - requests[i].t);
  events.insert(events.end(), read, read + k);
  counts_.read += k;
  requests = requests.subspan(k);
}

const core::Event& Readout::take_next() {
  Row& row = rows_[first_asking_];
  if (turn_left_ == 0) turn_left_ = row.waiting;
  Slot& slot = slots_[row.first];
  const std::uint32_t next = slot.next;
  slot.next = std::exchange(unused_, row.first);
  row.first = next;
  --row.waiting;
  --waiting_;
  if (--turn_left_ == 0) {
    // Whoever asked during the row's turn asks anew, behind the other rows.
    const std::uint16_t y = std::exchange(first_asking_, row.next_asking);
    if (row.waiting > 0) ask(y);
  }
  return slot.request;
}

/// Puts row `y` at the end of those that ask; what waits in it may be counted or not.
void Readout::ask(std::uint16_t y) {
  const bool others_ask = waiting_ > rows_[y].waiting;
  (others_ask ? rows_[last_asking_].next_asking : first_asking_) = y;
  last_asking_ = y;
}

void Readout::admit(core::Time now, std::span<const core::Event>& requests) {
  while (!requests.empty() && requests.front().t <= now) {
    const core::Event& request = requests.front();
    requests = requests.subspan(1);
    if (waiting_ >= config_.queue_capacity_events) {
      ++counts_.lost;
      continue;
    }
    if (unused_ == slots_.size()) slots_.push_back({request, unused_ + 1});
    const std::uint32_t slot = std::exchange(unused_, slots_[unused_].next);
    slots_[slot].request = request;
    Row& row = rows_[request.y];
    if (row.waiting == 0) {
      row.first = slot;
      ask(request.y);
    } else {
      slots_[row.last].next = slot;
    }
    row.last = slot;
    ++row.waiting;
    ++waiting_;
  }
}

}  // namespace nightjar::sim
