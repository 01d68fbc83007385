#include "scenarios/scenario_error.h"

#include <algorithm>

namespace nightjar::scenarios {

std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  std::string out = text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(out.begin(), out.end(), is_control, '?');
  return out;
}

}  // namespace nightjar::scenarios
