#include "camera/printable_text.h"

#include <algorithm>

namespace nightjar::camera {

std::string printable_text(std::string_view text, std::size_t most) {
  std::string shown(text.substr(0, most));
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return text.size() > most ? shown + "..." : shown;
}

}  // namespace nightjar::camera
