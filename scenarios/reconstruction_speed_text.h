#pragma once

#include <string>
#include <vector>

#include "scenarios/reconstruction_speed.h"

namespace nightjar::scenarios {

/// For people: a table for each workload, with ratios to the reference and to the bound.
std::string to_table(const std::vector<WorkloadSpeed>& speeds);
std::string to_table(const std::vector<MethodPictureTimes>& times);

/// For scripts: the same as one JSON object.
std::string to_json(const std::vector<WorkloadSpeed>& speeds,
                    const std::vector<MethodPictureTimes>& times);

/// Time per picture, and its share of the time between two pictures, against the pictures
/// a second: a PNG. Throws std::runtime_error where run_gnuplot() does.
std::string draw_picture_times(const std::string& workload,
                               const std::vector<MethodPictureTimes>& times);

}  // namespace nightjar::scenarios
