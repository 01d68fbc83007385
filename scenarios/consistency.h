#pragma once

namespace nightjar::scenarios {

struct Scenario;

/// Throws ScenarioError, naming the keys, for values that are each in range but do
/// not fit each other or the module they are for:
/// - waypoints in a row less than 1 mm apart,
/// - frames of the active pixels that follow each other faster than the world is drawn,
/// - sensor.pixel.log_linear_below between 0 and e, where the curve would step.
void check_consistency(const Scenario& scenario);

}  // namespace nightjar::scenarios
