#include "scenarios/reconstructor_feed.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "camera/gray_level.h"

namespace nightjar::scenarios {
namespace {

constexpr int kMostBits = 10;  // that esi::Reconstructor::add_frame() takes

}  // namespace

void ReconstructorFeed::add_frame(core::ApsFrame frame) {
  if (frame.bits > kMostBits) {
    frame.gray = camera::with_bits(std::move(frame.gray), frame.bits, kMostBits);
    frame.bits = kMostBits;
  }
  frames_.push_back(std::move(frame));
}

void ReconstructorFeed::advance(std::span<const core::Event> events, core::Time until) {
  for (; !frames_.empty() && frames_.front().exposure_end <= until; frames_.pop_front()) {
    const auto later =
        std::ranges::upper_bound(events, frames_.front().exposure_end, {}, &core::Event::t);
    const auto before = static_cast<std::size_t>(later - events.begin());
    reconstructor_.process(events.first(before));
    events = events.subspan(before);
    hand_over(std::move(frames_.front()));
  }
  reconstructor_.process(events);
}

void ReconstructorFeed::hand_over(core::ApsFrame&& frame) {
  try {
    reconstructor_.add_frame(std::move(frame));
    ++frames_taken_;
  } catch (const std::invalid_argument& error) {
    if (frames_refused_++ == 0) first_refusal_ = error.what();
  }
}

}  // namespace nightjar::scenarios
