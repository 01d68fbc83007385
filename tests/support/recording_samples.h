#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "camera/imu_axes.h"
#include "camera/recording.h"
#include "core/random.h"

namespace nightjar::test {

/// One of each kind of list, from `begin` on over about a second: 5000 events (several at
/// one time among them), 3 frames of 8 bits (one a region of interest), 100 IMU samples as a
/// file would hold them, 10 triggers of all types that AEDAT4 knows. Seed 5.
inline camera::RecordingPart sample_part(core::Resolution size, core::Time begin) {
  core::Random random = core::random_stream(5, "test.recording");
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  camera::RecordingPart part;
  core::Time t = begin;
  for (int i = 0; i < 5000; ++i) {
    t += core::Time(below(400));
    part.events.push_back({t, static_cast<std::uint16_t>(below(size.width_px)),
                           static_cast<std::uint16_t>(below(size.height_px)), below(2) == 1});
  }
  for (int i = 0; i < 3; ++i) {
    camera::RecordedFrame frame;
    frame.frame_begin = begin + core::Time(100'000 + 300'000 * i);
    frame.exposure_begin = frame.frame_begin + core::Time(9'000);
    frame.exposure_end = frame.exposure_begin + core::Time(4'000 + i);
    frame.frame_end = frame.exposure_end + core::Time(11'000);
    if (i == 2) frame.left_px = 3, frame.top_px = 5;
    frame.gray =
        core::Image<std::uint16_t>({size.width_px - frame.left_px, size.height_px - frame.top_px});
    for (std::uint16_t& level : frame.gray.pixels()) level = static_cast<std::uint16_t>(below(256));
    part.frames.push_back(frame);
  }
  for (int i = 0; i < 100; ++i) {
    const auto value = [&] { return static_cast<float>(below(4001) - 2000) / 1999.0f; };
    const camera::RawImu raw{{value(), value(), value()}, {value(), value(), value()}};
    part.imu.push_back(
        camera::to_camera_axes(begin + core::Time(10'000 * i), raw, 25.0f + value()));
  }
  const int types[] = {1, 2, 3, 4, 12, 13, 14, 15, 16, 17};
  for (int i = 0; i < 10; ++i) part.triggers.push_back({begin + core::Time(90'000 * i), types[i]});
  return part;
}

inline bool equal(const camera::RecordedFrame& a, const camera::RecordedFrame& b) {
  return a.frame_begin == b.frame_begin && a.frame_end == b.frame_end &&
         a.exposure_begin == b.exposure_begin && a.exposure_end == b.exposure_end &&
         a.left_px == b.left_px && a.top_px == b.top_px && a.bits == b.bits && a.gray == b.gray;
}

inline bool equal(const camera::RecordedImu& a, const camera::RecordedImu& b) {
  return a.t == b.t && a.temperature_c == b.temperature_c &&
         a.omega_camera_rad_s == b.omega_camera_rad_s &&
         a.specific_force_camera_m_s2 == b.specific_force_camera_m_s2;
}

/// What differs first, or nothing.
inline std::string difference(const camera::RecordingPart& a, const camera::RecordingPart& b) {
  const auto same = [](const auto& x, const auto& y) { return equal(x, y); };
  if (a.events != b.events) return "events";
  if (!std::ranges::equal(a.frames, b.frames, same)) return "frames";
  if (!std::ranges::equal(a.imu, b.imu, same)) return "imu";
  if (a.triggers != b.triggers) return "triggers";
  return "";
}

}  // namespace nightjar::test
