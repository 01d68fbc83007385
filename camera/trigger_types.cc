#include "camera/trigger_types.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace nightjar::camera {
namespace {

// By AEDAT4's numbers: reset of the clock; the external signal's rising edge, falling edge
// and pulse; the generator's rising and falling edge; begin and end of a frame and of its
// exposure.
constexpr std::array kLibcaer = {1, 2, 3, 4, 12, 13, 14, 15, 16, 17};

}  // namespace

std::optional<int> trigger_from_aedat4(int type) {
  if (type < 0 || type >= static_cast<int>(kLibcaer.size())) return std::nullopt;
  return kLibcaer[static_cast<std::size_t>(type)];
}

std::optional<int> trigger_to_aedat4(int type) {
  const auto* found = std::find(kLibcaer.begin(), kLibcaer.end(), type);
  if (found == kLibcaer.end()) return std::nullopt;
  return static_cast<int>(std::distance(kLibcaer.begin(), found));
}

}  // namespace nightjar::camera
