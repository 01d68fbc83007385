#pragma once

#include <cstddef>
#include <span>

#include "camera/aedat31_format.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

/// Adds the valid events of a packet to `part`, through `intake`: special (resets and
/// triggers), polarity, frame and IMU6, times of 64 bits. The layout is that of AEDAT 3.1,
/// which is also how libcaer has packets in memory. Frames have 8 or 10 bits where all
/// their pixels do (libcaer shifts them to the top of 16), else 16. `events` are whole
/// events of header.event_size bytes each, be they fewer than the header says; types we do
/// not read and sizes that cannot be are counted as faults.
void decode_caer_events(const Aedat31PacketHeader& header, std::span<const std::byte> events,
                        RecordingIntake& intake, RecordingPart& part);

/// As above for a packet that begins with its header. One that says it holds more than
/// `packet` does is counted as damaged and left alone.
void decode_caer_packet(std::span<const std::byte> packet, RecordingIntake& intake,
                        RecordingPart& part);

}  // namespace nightjar::camera
