#pragma once

#include "camera/recording.h"

namespace nightjar::camera {

/// An inertial sample in AEDAT's units: g and degrees per second, along the chip's axes.
struct RawImu {
  float acceleration_g[3] = {};
  float rate_deg_s[3] = {};
};

/// The chip of a DAVIS346 has its x to the left, y down and z backwards, seen along the
/// view, a frame right-handed as ours is: camera axes are (-x, +y, -z). So says iniVation's
/// page on the IMU, in other words: axes right, up and forward, with rates that count
/// against the right-hand rule; and a camera at rest reads y = -1 g.
RecordedImu to_camera_axes(core::Time t, const RawImu& raw, float temperature_c);

/// The reverse: exact for what came out of a file, else rounded to floats.
RawImu from_camera_axes(const core::ImuSample& sample);

/// Whether it is exact.
bool fits_floats(const core::ImuSample& sample);

}  // namespace nightjar::camera
