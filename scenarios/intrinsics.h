#pragma once

#include <filesystem>

#include "core/camera_model.h"

namespace nightjar::scenarios {

struct Scenario;
struct IntrinsicsConfig;

/// The camera in a file of IntrinsicsConfig's members. Throws ScenarioError, naming file,
/// line and column, for a file that cannot be read, an unknown key, a value out of range or
/// missing, and a lens that cannot be undone everywhere on the sensor.
core::CameraModel read_intrinsics(const std::filesystem::path& path);

/// What such a file says of `camera`, whether read_intrinsics() allows the values or not.
IntrinsicsConfig intrinsics_of(const core::CameraModel& camera);

/// Whether every pixel of the sensor's rim has a ray, so all within it do.
bool sees_with_all_pixels(const core::CameraModel& camera);

/// The camera that the tracker is to reckon with: source.intrinsics, or else the ideal
/// pinhole of the section camera. Throws as read_intrinsics() does.
core::CameraModel camera_model(const Scenario& scenario);

/// Throws ScenarioError when source.intrinsics is set for the simulator, is not a file of
/// intrinsics, or is of another size than the section camera.
void check_intrinsics(const Scenario& scenario);

}  // namespace nightjar::scenarios
