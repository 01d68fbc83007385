#pragma once

#include "camera/event_source.h"
#include "scenarios/source_link.h"

namespace nightjar::scenarios {

/// Has a camera be the source of a loop whose other nodes are other processes: each packet
/// goes out when it comes, as a free-running step, triggers, IMU samples and frames before the
/// events; the first also says the sensor's size and the camera's name.
/// `link` should hear no answers, and its while_waiting is called once a second at least,
/// whatever the camera does; what that throws ends it, else the camera's stop().
///
/// Where the camera was away for longer than a message can span, 35 minutes, the packet after
/// it begins at its first datum. Throws as camera.start() and link.exchange() do.
void send_camera(camera::EventSource& camera, SourceLink& link);

}  // namespace nightjar::scenarios
