#pragma once

#include <string>
#include <vector>

#include "scenarios/pass_criteria_config.h"
#include "scenarios/summary.h"

namespace nightjar::scenarios {

/// What the run missed, one line each, such as
/// "detection_rate = 0.61, wanted at least 0.74"; empty when it passed.
std::vector<std::string> failed_criteria(const PassCriteria& criteria, const Summary& summary);

}  // namespace nightjar::scenarios
