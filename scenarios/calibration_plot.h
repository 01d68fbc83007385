#pragma once

#include <string>

#include "scenarios/calibration_report.h"

namespace nightjar::scenarios {

/// A PNG from which a person sees whether the views suffice: where on the sensor corners lie and
/// lack, with their residuals enlarged; the residuals themselves; each view's rms; and how far the
/// lens moves things from where a pinhole would show them. Throws as run_gnuplot() does.
std::string draw_png(const CalibrationReport& report);

}  // namespace nightjar::scenarios
