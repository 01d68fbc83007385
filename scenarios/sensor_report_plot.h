#pragma once

#include <string>

#include "scenarios/sensor_report.h"

namespace nightjar::scenarios {

/// The report as a PNG picture, all streams in the same axes: how many pixels fire how
/// often, intervals between a pixel's events, shares of ON, and for each stream a map of
/// the rates with the hot pixels ringed. Of at most 3 columns.
/// Throws std::runtime_error where run_gnuplot() does.
std::string draw_png(const SensorReport& report);

}  // namespace nightjar::scenarios
