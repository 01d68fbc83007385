#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "camera/recording.h"

namespace nightjar::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// What `open` makes of any bytes is a recording whose lists are ordered and on the sensor, or
/// an invalid_argument whose text is one line. Anything else is a finding.
template <class Open>
int read_opened(core::Resolution sensor, Open open) {
  try {
    const std::unique_ptr<camera::RecordingReader> reader = open();
    core::Time event{}, frame{}, imu{}, trigger{};
    for (camera::RecordingPart part; reader->next(part);) {
      for (const core::Event& each : part.events) {
        require(each.t >= event && each.x < sensor.width_px && each.y < sensor.height_px);
        event = each.t;
      }
      for (const camera::RecordedFrame& each : part.frames) {
        require(each.exposure_end >= each.exposure_begin && each.exposure_end >= frame);
        require(each.left_px >= 0 && each.left_px + each.gray.width() <= sensor.width_px);
        require(each.top_px >= 0 && each.top_px + each.gray.height() <= sensor.height_px);
        frame = each.exposure_begin + (each.exposure_end - each.exposure_begin) / 2;
      }
      for (const camera::RecordedImu& each : part.imu) {
        require(each.t >= imu && each.omega_camera_rad_s.allFinite());
        imu = each.t;
      }
      for (const camera::Trigger& each : part.triggers) {
        require(each.t >= trigger);
        trigger = each.t;
      }
      require(reader->progress() >= 0 && reader->progress() <= 1);
    }
    require(reader->faults().first.find('\n') == std::string::npos);
  } catch (const std::invalid_argument& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}

/// The same of the bytes behind `beginning`.
inline int read_recording(std::string_view beginning, const std::uint8_t* data, std::size_t size,
                          core::Resolution sensor) {
  return read_opened(sensor, [&] {
    std::string bytes(beginning);
    bytes.append(reinterpret_cast<const char*>(data), size);
    return camera::open_recording(std::make_unique<std::istringstream>(std::move(bytes)), "fuzz",
                                  sensor);
  });
}

}  // namespace nightjar::fuzz
