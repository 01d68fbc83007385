#include <fmt/format.h>

#include <nightjar_lcm/aps_readout_t.hpp>
#include <nightjar_lcm/imu_temperature_t.hpp>
#include <nightjar_lcm/sensor_t.hpp>
#include <nightjar_lcm/trigger_t.hpp>

#include "core/trigger.h"
#include "msg/convert.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

void check(const SensorNote& sensor) {
  for (const int side_px : {sensor.size.width_px, sensor.size.height_px})
    if (side_px < 1 || side_px > core::kMostSide_px)
      throw std::invalid_argument(fmt::format("sensor_t: {}x{} px, allowed 1 to {} a side",
                                              sensor.size.width_px, sensor.size.height_px,
                                              core::kMostSide_px));
}

void check(const TriggerNote& trigger) {
  if (trigger.type < 0 || trigger.type > core::kMostTriggerType)
    throw std::invalid_argument(
        fmt::format("trigger_t: type = {}, allowed 0 to {}", trigger.type, core::kMostTriggerType));
}

}  // namespace

Bytes encode(const SensorNote& sensor) {
  check(sensor);
  nightjar_lcm::sensor_t message;
  message.time_us = to_us(sensor.t);
  message.width_px = sensor.size.width_px;
  message.height_px = sensor.size.height_px;
  message.camera = sensor.camera;
  return to_bytes(message);
}

template <>
SensorNote decode(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8 + 4 + 4;  // fingerprint, time_us, size
  check_array_fits("sensor_t", bytes, kCountOffset, 1);
  const auto message = from_bytes<nightjar_lcm::sensor_t>(bytes);
  SensorNote sensor{
      core::Time(message.time_us), {message.width_px, message.height_px}, message.camera};
  check(sensor);
  return sensor;
}

Bytes encode(const TriggerNote& trigger) {
  check(trigger);
  nightjar_lcm::trigger_t message;
  message.time_us = to_us(trigger.t);
  message.type = trigger.type;
  return to_bytes(message);
}

template <>
TriggerNote decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::trigger_t>(bytes);
  const TriggerNote trigger{core::Time(message.time_us), message.type};
  check(trigger);
  return trigger;
}

Bytes encode(const ReadoutNote& readout) {
  nightjar_lcm::aps_readout_t message;
  message.time_us = to_us(readout.t);
  message.frame_begin_us = to_us(readout.frame_begin);
  message.frame_end_us = to_us(readout.frame_end);
  message.left_px = readout.left_px;
  message.top_px = readout.top_px;
  return to_bytes(message);
}

template <>
ReadoutNote decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::aps_readout_t>(bytes);
  return {core::Time(message.time_us), core::Time(message.frame_begin_us),
          core::Time(message.frame_end_us), message.left_px, message.top_px};
}

Bytes encode(const TemperatureNote& temperature) {
  nightjar_lcm::imu_temperature_t message;
  message.time_us = to_us(temperature.t);
  message.temperature_c = temperature.temperature_c;
  return to_bytes(message);
}

template <>
TemperatureNote decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::imu_temperature_t>(bytes);
  return {core::Time(message.time_us), message.temperature_c};
}

}  // namespace nightjar::msg
