#pragma once

#include <string>
#include <string_view>

namespace nightjar::scenarios {

/// The unit that ends a parameter's name, as people write it: "m/s" for `speed_m_s`.
/// Empty for a name without one.
std::string unit_of(std::string_view name);

}  // namespace nightjar::scenarios
