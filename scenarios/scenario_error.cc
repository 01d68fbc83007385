#include "scenarios/scenario_error.h"

#include <algorithm>

namespace nightjar::scenarios {

std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return shown_file(text.size() <= kLongest ? text : text.substr(0, kLongest) + "...");
}

std::string shown_file(std::string path) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(path.begin(), path.end(), is_control, '?');
  return path;
}

}  // namespace nightjar::scenarios
