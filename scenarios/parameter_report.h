#pragma once

#include <optional>
#include <string>

namespace nightjar::scenarios {

/// Every parameter of a scenario file (to_text in parameter_table.h), and after them
/// those that exist only with sensor.preset = custom.
std::string parameters_text();

/// The same as a JSON list of objects: parameter, default, allowed, unit, source; what
/// is not stated is left out. A default is a number, a list or a truth value where it is
/// one in the file. What exists only under a condition names it in "only_with".
std::string parameters_json();

/// The pixel's parameters under the presets clean, bright and dim, and, with an
/// illuminance, what preset by_illuminance makes of it. Throws std::invalid_argument
/// for an illuminance that is not > 0.
std::string presets_text(std::optional<double> illuminance_lux);

}  // namespace nightjar::scenarios
