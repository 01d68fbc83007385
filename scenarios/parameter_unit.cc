#include "scenarios/parameter_unit.h"

#include <array>
#include <utility>

namespace nightjar::scenarios {
namespace {

// An ending that ends another one comes after it.
constexpr std::array kUnits = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"_deg_s_sqrt_hz", "deg/s/sqrt(Hz)"},
    {"_ug_sqrt_hz", "ug/sqrt(Hz)"},
    {"_n_s_m", "N s/m"},
    {"_m_s2", "m/s^2"},
    {"_m_s", "m/s"},
    {"_rad_s", "rad/s"},
    {"_deg_s", "deg/s"},
    {"_1_s", "1/s"},
    {"_hz2", "Hz^2"},
    {"_px2", "px^2"},
    {"_decades", "decades"},
    {"_events", "events"},
    {"_lux", "lux"},
    {"_deg", "deg"},
    {"_rad", "rad"},
    {"_log", "ln"},
    {"_ln", "ln"},
    {"_hz", "Hz"},
    {"_px", "px"},
    {"_ms", "ms"},
    {"_us", "us"},
    {"_mg", "mg"},
    {"_e", "electrons"},
    {"_g", "g"},
    {"_m", "m"},
    {"_n", "N"},
    {"_s", "s"},
});

}  // namespace

std::string unit_of(std::string_view name) {
  for (const auto& [ending, unit] : kUnits)
    if (name.ends_with(ending)) return std::string(unit);
  return {};
}

}  // namespace nightjar::scenarios
