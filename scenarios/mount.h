#pragma once

#include <Eigen/Geometry>

#include "camera/mount_config.h"

namespace nightjar::scenarios {

struct Scenario;

Eigen::Isometry3d T_body_camera(const camera::MountConfig& mount);

/// Throws ScenarioError when source.mount is changed for the simulator, whose camera sits
/// where its model says.
void check_mount(const Scenario& scenario);

}  // namespace nightjar::scenarios
