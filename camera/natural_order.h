#pragma once

#include <string_view>

namespace nightjar::camera {

/// Orders names as people number files: runs of digits by their value, so that
/// frame2 comes before frame10; everything else by its bytes.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace nightjar::camera
