#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/imu.h"
#include "core/state.h"
#include "core/truth.h"
#include "msg/camera_notes.h"
#include "msg/step_mark.h"
#include "msg/tag_detections.h"

namespace nightjar::msg {

using Bytes = std::vector<std::uint8_t>;

/// A value as its LCM type (msg/*.lcm) lies on the wire, fingerprint first.
/// Nothing is rounded: decode<T>(encode(value)) has the bits of `value`.
/// Throws std::invalid_argument for a value that breaks its own type's promise:
/// an event outside (begin, end] or out of order, a packet longer than 2^31 - 1
/// us, a frame of other than 8, 10 or 16 bits or with a pixel beyond them, a tag of
/// another time than its picture, a sensor of no size or over 32767 a side, a trigger's
/// type beyond 0 to 127, text with a zero byte inside.
Bytes encode(const core::EventPacket& packet);
Bytes encode(const core::Picture& picture);
Bytes encode(const core::ApsFrame& frame);
Bytes encode(const core::ImuSample& sample);
Bytes encode(const TagDetections& detections);
Bytes encode(const core::TargetEstimate& estimate);
Bytes encode(const core::VehicleState& state);
Bytes encode(const core::AttitudeSetpoint& setpoint);
Bytes encode(const core::MissionTransition& transition);
Bytes encode(const core::Truth& truth);
Bytes encode(const StepMark& mark);
Bytes encode(const SensorNote& sensor);
Bytes encode(const TriggerNote& trigger);
Bytes encode(const ReadoutNote& readout);
Bytes encode(const TemperatureNote& temperature);

/// The value in an LCM message. Throws std::invalid_argument when the bytes are
/// of another type, too few or too many, or break the promise of T.
template <class T>
T decode(std::span<const std::uint8_t> bytes);

template <>
core::EventPacket decode(std::span<const std::uint8_t> bytes);
template <>
core::Picture decode(std::span<const std::uint8_t> bytes);
template <>
core::ApsFrame decode(std::span<const std::uint8_t> bytes);
template <>
core::ImuSample decode(std::span<const std::uint8_t> bytes);
template <>
TagDetections decode(std::span<const std::uint8_t> bytes);
template <>
core::TargetEstimate decode(std::span<const std::uint8_t> bytes);
template <>
core::VehicleState decode(std::span<const std::uint8_t> bytes);
template <>
core::AttitudeSetpoint decode(std::span<const std::uint8_t> bytes);
template <>
core::MissionTransition decode(std::span<const std::uint8_t> bytes);
template <>
core::Truth decode(std::span<const std::uint8_t> bytes);
template <>
StepMark decode(std::span<const std::uint8_t> bytes);
template <>
SensorNote decode(std::span<const std::uint8_t> bytes);
template <>
TriggerNote decode(std::span<const std::uint8_t> bytes);
template <>
ReadoutNote decode(std::span<const std::uint8_t> bytes);
template <>
TemperatureNote decode(std::span<const std::uint8_t> bytes);

/// The time of any message of ours: time_us is the first field of each type.
/// Throws std::invalid_argument when there are too few bytes to hold one.
core::Time message_time(std::span<const std::uint8_t> bytes);

}  // namespace nightjar::msg
