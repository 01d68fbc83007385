#include "scenarios/log_recording_writer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "msg/channels.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kStep = 10ms;

/// How much later than events of its time the rest may come in a recording and still be
/// written with them.
constexpr core::Time kLag = 100ms;

/// Events far apart, or a clock that jumped ahead by years, must not fill the disk with empty
/// steps.
constexpr core::Time kMostPause = 1s;

// What waits for its step, so that memory is bounded whatever the times are.
constexpr std::size_t kMostEvents = std::size_t{1} << 21;
constexpr std::size_t kMostSamples = 100'000;
constexpr std::size_t kMostFrames = 32;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The first of `list` whose `time` is at most `until`, taken out of it.
template <class T, class Member>
std::vector<T> take_until(std::vector<T>& list, core::Time until, Member time) {
  const auto later = std::ranges::upper_bound(list, until, {}, time);
  std::vector<T> taken(std::make_move_iterator(list.begin()), std::make_move_iterator(later));
  list.erase(list.begin(), later);
  return taken;
}

core::Time middle_of(const camera::RecordedFrame& frame) {
  return frame.exposure_begin + (frame.exposure_end - frame.exposure_begin) / 2;
}

}  // namespace

LogRecordingWriter::LogRecordingWriter(const std::filesystem::path& path,
                                       const camera::RecordingHead& head)
    : head_(head), check_(head.size), log_(path) {}

void LogRecordingWriter::write_head(core::Time t) {
  if (std::exchange(head_written_, true)) return;
  put(msg::kSensor, msg::SensorNote{t, head_.size, head_.camera});
}

void LogRecordingWriter::write(const camera::RecordingPart& part) {
  check_.check(part);
  write_head(part.first_time());
  append(waiting_.events, part.events);
  append(waiting_.frames, part.frames);
  append(waiting_.imu, part.imu);
  append(waiting_.triggers, part.triggers);
  if (!begun_ && !waiting_.events.empty()) {
    begun_ = true;
    begin_ = waiting_.events.front().t - 1us;  // packets hold their end, not their beginning
  }
  while (!waiting_.events.empty() &&
         (waiting_.events.back().t > begin_ + kStep + kLag || waiting_.events.size() > kMostEvents))
    write_step();
  if (waiting_.triggers.size() > kMostSamples) write_triggers(core::Time::max());
  if (waiting_.imu.size() > kMostSamples) write_imu(core::Time::max());
  if (waiting_.frames.size() > kMostFrames) write_frames(core::Time::max());
}

/// There are events waiting.
void LogRecordingWriter::write_step() {
  const core::Time first = waiting_.events.front().t;
  if (first > begin_ + kMostPause) begin_ = first - 1us;
  core::EventPacket packet{begin_, begin_ + kStep, {}};
  // Of those that crowd at one time, some come in a packet that begins anew before it.
  packet.begin = std::min(packet.begin, first - 1us);
  if (waiting_.events.size() > kMostEvents)
    packet.end = std::min(packet.end, waiting_.events[kMostEvents].t);
  const std::size_t crowd = std::min(waiting_.events.size(), kMostEvents);
  const auto end = waiting_.events.begin() + static_cast<std::ptrdiff_t>(crowd);
  const auto later =
      std::ranges::upper_bound(waiting_.events.begin(), end, packet.end, {}, &core::Event::t);
  packet.events.assign(waiting_.events.begin(), later);
  waiting_.events.erase(waiting_.events.begin(), later);
  write_triggers(packet.end);
  write_imu(packet.end);
  write_frames(packet.end);
  put(msg::kEvents, packet);
  begin_ = packet.end;
}

void LogRecordingWriter::write_triggers(core::Time until) {
  for (const camera::Trigger& trigger : take_until(waiting_.triggers, until, &camera::Trigger::t))
    put(msg::kTrigger, msg::TriggerNote{trigger.t, trigger.type});
}

void LogRecordingWriter::write_imu(core::Time until) {
  for (const camera::RecordedImu& sample :
       take_until(waiting_.imu, until, &camera::RecordedImu::t)) {
    if (!std::isnan(sample.temperature_c))
      put(msg::kImuTemperature, msg::TemperatureNote{sample.t, sample.temperature_c});
    put<core::ImuSample>(msg::kImu, sample);
  }
}

void LogRecordingWriter::write_frames(core::Time until) {
  for (const camera::RecordedFrame& frame : take_until(waiting_.frames, until, &middle_of)) {
    put(msg::kApsReadout, msg::ReadoutNote{frame.exposure_end, frame.frame_begin, frame.frame_end,
                                           frame.left_px, frame.top_px});
    put<core::ApsFrame>(msg::kApsFrame, frame);
  }
}

void LogRecordingWriter::finish() {
  write_head(core::Time{});
  while (!waiting_.events.empty()) write_step();
  write_triggers(core::Time::max());
  write_imu(core::Time::max());
  write_frames(core::Time::max());
  log_.finish();
}

}  // namespace nightjar::scenarios
