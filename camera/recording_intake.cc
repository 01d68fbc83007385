#include "camera/recording_intake.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace nightjar::camera {
namespace {

/// A camera's queues mix up microseconds, not seconds.
constexpr core::Time kReset = std::chrono::seconds(1);

/// More is no clock; and it bounds what is kept of them.
constexpr std::size_t kMostResets = 10000;

}  // namespace

void RecordingIntake::fault(std::uint64_t RecordingFaults::*count, const std::string& why,
                            std::uint64_t amount) {
  faults_.*count += amount;
  if (faults_.first.empty()) faults_.first = place_() + ": " + why;
}

void RecordingIntake::expect_reset() {
  for (Clock& clock : clocks_) clock.reset_expected = true;
}

bool RecordingIntake::begin_epoch(Clock& clock, core::Time raw) {
  if (clock.epoch == kMostResets) return false;
  if (++clock.epoch == shifts_.size()) {
    shifts_.push_back(latest_ - raw);
    fault(&RecordingFaults::time_resets, fmt::format("the clock goes back from {} us to {} us",
                                                     clock.last_raw.count(), raw.count()));
  }
  clock.reset_expected = false;
  return true;
}

std::optional<core::Time> RecordingIntake::place_in_time(List list, core::Time raw) {
  Clock& clock = clocks_[list];
  bool possible = raw >= core::Time{} && raw <= kMostTime;
  if (possible && raw < clock.last_raw) {
    const bool reset = clock.reset_expected || clock.last_raw - raw > kReset;
    possible = reset && begin_epoch(clock, raw);
  }
  const core::Time shifted = possible ? raw + shifts_[clock.epoch] : core::Time{};
  if (!possible || shifted > kMostTime) {
    fault(&RecordingFaults::events_backwards,
          fmt::format("time = {} us, allowed {} to {} us", raw.count(), clock.last_raw.count(),
                      kMostTime.count()));
    return std::nullopt;
  }
  clock.last_raw = raw;
  clock.last = std::max(shifted, clock.last);  // lists may differ by what was on its way
  latest_ = std::max(latest_, clock.last);
  return clock.last;
}

void RecordingIntake::add(const core::Event& event, RecordingPart& part) {
  if (event.x >= size_.width_px || event.y >= size_.height_px) {
    fault(&RecordingFaults::events_outside,
          fmt::format("an event at x = {}, y = {}, outside {}x{}", event.x, event.y, size_.width_px,
                      size_.height_px));
    return;
  }
  if (const auto t = place_in_time(kEvents, event.t))
    part.events.push_back({*t, event.x, event.y, event.on});
}

void RecordingIntake::add(RecordedFrame frame, RecordingPart& part) {
  if (frame.left_px < 0 || frame.top_px < 0 ||
      frame.left_px > size_.width_px - frame.gray.width() ||
      frame.top_px > size_.height_px - frame.gray.height()) {
    fault(&RecordingFaults::events_outside,
          fmt::format("a frame of {}x{} at x = {}, y = {}, outside {}x{}", frame.gray.width(),
                      frame.gray.height(), frame.left_px, frame.top_px, size_.width_px,
                      size_.height_px));
    return;
  }
  for (const core::Time t :
       {frame.frame_begin, frame.frame_end, frame.exposure_begin, frame.exposure_end})
    if (t < core::Time{} || t > kMostTime || frame.exposure_end < frame.exposure_begin) {
      fault(&RecordingFaults::packets_damaged,
            fmt::format("a frame exposed from {} to {} us", frame.exposure_begin.count(),
                        frame.exposure_end.count()));
      return;
    }
  const core::Time middle = frame.exposure_begin + (frame.exposure_end - frame.exposure_begin) / 2;
  const auto t = place_in_time(kFrames, middle);
  if (!t) return;
  for (core::Time* each :
       {&frame.frame_begin, &frame.frame_end, &frame.exposure_begin, &frame.exposure_end})
    *each += *t - middle;
  part.frames.push_back(std::move(frame));
}

void RecordingIntake::add(RecordedImu sample, RecordingPart& part) {
  if (!sample.omega_camera_rad_s.allFinite() || !sample.specific_force_camera_m_s2.allFinite()) {
    fault(&RecordingFaults::packets_damaged, "an IMU sample that is no number");
    return;
  }
  const auto t = place_in_time(kImu, sample.t);
  if (!t) return;
  sample.t = *t;
  part.imu.push_back(sample);
}

void RecordingIntake::add(Trigger trigger, RecordingPart& part) {
  const auto t = place_in_time(kTriggers, trigger.t);
  if (t) part.triggers.push_back({*t, trigger.type});
}

}  // namespace nightjar::camera
