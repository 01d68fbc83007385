#include "scenarios/recording_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "msg/channels.h"
#include "scenarios/recording_info.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kInterval = 10ms;

// What waits for events of its time, so that memory is bounded in a recording without any.
constexpr std::size_t kMostSamples = 100'000;
constexpr std::size_t kMostFrames = 32;

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// The first of `list` whose `time` is at most `end`, taken out of it.
template <class T, class Member>
std::vector<T> take_until(std::vector<T>& list, core::Time end, Member time) {
  const auto later = std::ranges::upper_bound(list, end, {}, time);
  std::vector<T> taken(std::make_move_iterator(list.begin()), std::make_move_iterator(later));
  list.erase(list.begin(), later);
  return taken;
}

/// Lets the older half of more than `most` go; how many that were.
template <class T>
std::size_t make_room(std::vector<T>& list, std::size_t most) {
  if (list.size() <= most) return 0;
  const std::size_t old = list.size() / 2;
  list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(old));
  return old;
}

}  // namespace

RecordingSteps::RecordingSteps(std::unique_ptr<camera::RecordingReader> recording)
    : recording_(std::move(recording)) {
  read_up_to(core::Time::min());
  if (waiting_.events.empty()) throw std::invalid_argument("the recording holds no events");
  begin_ = waiting_.events.front().t - 1us;  // packets hold their end, not their beginning
}

/// Reads on until there is an event later than `end`, so that all up to it have come.
void RecordingSteps::read_up_to(core::Time end) {
  while (more_ && (waiting_.events.empty() || waiting_.events.back().t <= end)) {
    more_ = recording_->next(part_);
    if (!more_) return;
    append(waiting_.events, part_.events);
    append(waiting_.frames, part_.frames);
    append(waiting_.imu, part_.imu);
    left_out_ += make_room(waiting_.frames, kMostFrames);
    left_out_ += make_room(waiting_.imu, kMostSamples);
  }
}

std::string RecordingSteps::faults() const {
  std::string text = fault_text(recording_->faults());
  if (left_out_ == 0) return text;
  if (!text.empty()) text += "; ";
  return text +
         fmt::format("left out {} frames and IMU samples of a time without events", left_out_);
}

std::optional<core::Time> RecordingSteps::next(msg::Bus& bus) {
  const core::Time end = begin_ + kInterval;
  read_up_to(end);
  if (waiting_.events.empty()) return std::nullopt;
  for (const auto& sample : take_until(waiting_.imu, end, &camera::RecordedImu::t))
    bus.publish<core::ImuSample>(msg::kImu, sample);
  for (const auto& frame : take_until(waiting_.frames, end, &camera::RecordedFrame::exposure_end))
    bus.publish<core::ApsFrame>(msg::kApsFrame, frame);
  bus.publish(msg::kEvents, {begin_, end, take_until(waiting_.events, end, &core::Event::t)});
  return begin_ = end;
}

}  // namespace nightjar::scenarios
