#include "camera/recording_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "camera/recording_intake.h"
#include "core/config_check.h"
#include "core/trigger.h"

namespace nightjar::camera {
namespace {

void check_time(const char* what, core::Time t, core::Time& last) {
  if (t < last || t > kMostTime)
    throw std::invalid_argument(fmt::format("{} at {} us, allowed {} to {} us", what, t.count(),
                                            last.count(), kMostTime.count()));
  last = t;
}

void check_frame(const RecordedFrame& frame, core::Resolution size, core::Time& last) {
  const auto [first, latest] =
      std::minmax({frame.frame_begin, frame.frame_end, frame.exposure_begin, frame.exposure_end});
  core::Time earliest{};
  check_time("frame", first, earliest);
  check_time("frame", latest, earliest);
  if (frame.exposure_end < frame.exposure_begin)
    throw std::invalid_argument("frame with an exposure that ends before it begins");
  check_time("frame", frame.exposure_begin + (frame.exposure_end - frame.exposure_begin) / 2, last);
  if (frame.gray.empty() || frame.left_px < 0 || frame.top_px < 0 ||
      frame.left_px + frame.gray.width() > size.width_px ||
      frame.top_px + frame.gray.height() > size.height_px)
    throw std::invalid_argument(fmt::format("frame of {}x{} px at x = {}, y = {} on {}x{}",
                                            frame.gray.width(), frame.gray.height(), frame.left_px,
                                            frame.top_px, size.width_px, size.height_px));
}

}  // namespace

void RecordingCheck::check(const RecordingPart& part) {
  for (const core::Event& event : part.events) {
    check_time("event", event.t, event_);
    if (event.x >= size_.width_px || event.y >= size_.height_px)
      throw std::invalid_argument(fmt::format("event at x = {}, y = {} on {}x{}", event.x, event.y,
                                              size_.width_px, size_.height_px));
  }
  for (const RecordedFrame& frame : part.frames) check_frame(frame, size_, frame_);
  for (const RecordedImu& sample : part.imu) check_time("IMU sample", sample.t, imu_);
  for (const Trigger& trigger : part.triggers) {
    check_time("trigger", trigger.t, trigger_);
    core::check_range("trigger.type", trigger.type, 0, core::kMostTriggerType);
  }
}

}  // namespace nightjar::camera
