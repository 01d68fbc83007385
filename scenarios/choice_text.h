#pragma once

#include <string>

#include "core/config_check.h"

namespace nightjar::scenarios {

/// The name `value` has in a scenario file; empty for a value without one.
template <class Enum, std::size_t N>
std::string choice_name(const Enum& value, const core::Choices<Enum, N>& choices) {
  for (const auto& [name, each] : choices)
    if (each == value) return name;
  return {};
}

/// Every allowed name: "a, b, c".
template <class Enum, std::size_t N>
std::string choice_names(const core::Choices<Enum, N>& choices) {
  std::string names;
  for (const auto& each : choices) names += (names.empty() ? "" : ", ") + std::string(each.first);
  return names;
}

}  // namespace nightjar::scenarios
