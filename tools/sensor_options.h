#pragma once

#include <string>

#include "core/event.h"
#include "sim/sensor_config.h"

namespace nightjar::tools {

/// The value of --size, "346x260". Throws std::invalid_argument for anything else, and
/// for a side that is not 1 to 32767 px.
core::Resolution parse_size(const std::string& text);

/// The value of --preset; `custom` is for scenario files alone, as its pixels are there.
/// Throws std::invalid_argument that lists what is allowed.
sim::SensorPreset parse_preset(const std::string& name);

/// What parse_preset() takes: "by_illuminance, clean, ..."
std::string preset_names();

}  // namespace nightjar::tools
