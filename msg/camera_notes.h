#pragma once

#include <string>

#include "core/event.h"

// What recordings of real cameras hold beyond the types of core/: a log carries it too, so
// that nothing is lost on the way through it.
namespace nightjar::msg {

/// The camera whose data follow (msg/sensor_t.lcm).
struct SensorNote {
  core::Time t{};
  core::Resolution size;
  std::string camera;  ///< As it calls itself; may be empty.

  friend bool operator==(const SensorNote&, const SensorNote&) = default;
};

/// A signal at another input of the camera, or a mark of its own (msg/trigger_t.lcm).
struct TriggerNote {
  core::Time t{};
  int type = 0;  ///< libcaer's number of the special event, 0 to 127.

  friend bool operator==(const TriggerNote&, const TriggerNote&) = default;
};

/// Of the core::ApsFrame that comes next (msg/aps_readout_t.lcm).
struct ReadoutNote {
  core::Time t{};  ///< End of its exposure.
  core::Time frame_begin{};
  core::Time frame_end{};
  int left_px = 0;  ///< Of its top left pixel, on the sensor.
  int top_px = 0;

  friend bool operator==(const ReadoutNote&, const ReadoutNote&) = default;
};

/// Of the core::ImuSample that comes next (msg/imu_temperature_t.lcm).
struct TemperatureNote {
  core::Time t{};
  float temperature_c = 0;

  friend bool operator==(const TemperatureNote&, const TemperatureNote&) = default;
};

}  // namespace nightjar::msg
