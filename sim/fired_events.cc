#include "sim/fired_events.h"

#include <functional>

namespace nightjar::sim {

void FiredEvents::hand_over(core::Time begin, core::Time step, int width_px,
                            std::vector<core::Event>& events) {
  const auto most = (static_cast<std::uint64_t>(step.count()) << 32) | UINT32_MAX;
  order_.sort(keys_, most, std::identity(), std::less());
  // A product, since a division takes long; the half keeps rounding on the right side.
  const auto width = static_cast<std::uint32_t>(width_px);
  const double rows_per_pixel = 1.0 / width_px;
  for (const std::uint64_t key : keys_) {
    const std::uint32_t pixel = static_cast<std::uint32_t>(key) >> 1;
    const auto y = static_cast<std::uint32_t>((pixel + 0.5) * rows_per_pixel);
    events.push_back({begin + core::Time(key >> 32), static_cast<std::uint16_t>(pixel - y * width),
                      static_cast<std::uint16_t>(y), (key & 1) != 0});
  }
  keys_.clear();
}

}  // namespace nightjar::sim
