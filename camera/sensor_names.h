#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/event.h"

namespace nightjar::camera {

/// The sensor of a camera by its name in AEDAT 2.0 and 3.1 files, such as DAVIS346 or
/// eu.seebetter.ini.chips.davis.Davis240C; nothing for one we do not know.
std::optional<core::Resolution> sensor_of(std::string_view name);

/// A camera with such a sensor, by the name that AEDAT 3.1 files use; empty if we know none.
std::string name_of(core::Resolution sensor);

}  // namespace nightjar::camera
