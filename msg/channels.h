#pragma once

#include "core/event.h"
#include "core/image.h"
#include "core/imu.h"
#include "core/state.h"
#include "core/truth.h"
#include "msg/camera_notes.h"
#include "msg/step_mark.h"
#include "msg/tag_detections.h"

namespace nightjar::msg {

/// An LCM channel and the one type that travels on it.
template <class T>
struct Channel {
  const char* name;
};

inline constexpr Channel<core::EventPacket> kEvents{"NIGHTJAR_EVENTS"};
inline constexpr Channel<core::Picture> kPicture{"NIGHTJAR_PICTURE"};
inline constexpr Channel<core::ApsFrame> kApsFrame{"NIGHTJAR_APS_FRAME"};
inline constexpr Channel<core::ImuSample> kImu{"NIGHTJAR_IMU"};
inline constexpr Channel<TagDetections> kTagDetections{"NIGHTJAR_TAG_DETECTIONS"};
inline constexpr Channel<core::TargetEstimate> kTargetEstimate{"NIGHTJAR_TARGET_ESTIMATE"};
inline constexpr Channel<core::VehicleState> kVehicleState{"NIGHTJAR_VEHICLE_STATE"};
inline constexpr Channel<core::AttitudeSetpoint> kAttitudeSetpoint{"NIGHTJAR_ATTITUDE_SETPOINT"};
inline constexpr Channel<core::MissionTransition> kMissionTransition{"NIGHTJAR_MISSION_TRANSITION"};
inline constexpr Channel<core::Truth> kTruth{"NIGHTJAR_TRUTH"};
inline constexpr Channel<StepMark> kStep{"NIGHTJAR_STEP"};
// In logs of recordings:
inline constexpr Channel<SensorNote> kSensor{"NIGHTJAR_SENSOR"};
inline constexpr Channel<TriggerNote> kTrigger{"NIGHTJAR_TRIGGER"};
inline constexpr Channel<ReadoutNote> kApsReadout{"NIGHTJAR_APS_READOUT"};
inline constexpr Channel<TemperatureNote> kImuTemperature{"NIGHTJAR_IMU_TEMPERATURE"};
/// Between processes event packets travel in pieces (msg/event_parts.h), here.
inline constexpr const char* kEventParts = "NIGHTJAR_EVENT_PARTS";

}  // namespace nightjar::msg
