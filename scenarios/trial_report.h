#pragma once

#include <string>
#include <vector>

#include "scenarios/trial.h"

namespace nightjar::scenarios {

/// A row for each motion and light, a column for each entry, "detection rate in % / SSIM",
/// and a row of means with the false detections.
std::string trial_table(const TrialConfig& config, const std::vector<TrialEntry>& entries,
                        const std::vector<TrialScore>& scores);

/// Every score on its own: a list of objects.
std::string trial_json(const std::vector<TrialScore>& scores);

}  // namespace nightjar::scenarios
