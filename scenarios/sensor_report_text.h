#pragma once

#include <string>

#include "scenarios/sensor_report.h"

namespace nightjar::scenarios {

/// A line for each figure, a column for each stream; "-" where a figure does not exist.
std::string to_table(const SensorReport& report);

/// One indented object that ends in a line break; null where a figure does not exist.
std::string to_json(const SensorReport& report);

}  // namespace nightjar::scenarios
