#include "sim/background_activity_filter.h"

namespace nightjar::sim {
namespace {

constexpr std::int64_t kNever = INT64_MIN / 2;

}  // namespace

BackgroundActivityFilter::BackgroundActivityFilter(const BackgroundActivityConfig& config,
                                                   core::Resolution size)
    : config_(config), stride_(static_cast<std::size_t>(size.width_px) + 2) {
  core::check_config(config, "background_activity_filter");
  core::check_range("size.width_px", size.width_px, 1, 65535);
  core::check_range("size.height_px", size.height_px, 1, 65535);
  last_us_.assign(stride_ * (static_cast<std::size_t>(size.height_px) + 2), kNever);
}

void BackgroundActivityFilter::filter(std::vector<core::Event>& events) {
  if (!config_.enabled) return;
  dropped_ += std::erase_if(events, [this](const core::Event& event) { return !passes(event); });
}

bool BackgroundActivityFilter::passes(const core::Event& event) {
  std::int64_t* centre = &last_us_[(event.y + 1u) * stride_ + event.x + 1u];
  const std::int64_t* above = centre - stride_;
  const std::int64_t* below = centre + stride_;
  const std::int64_t since_us = event.t.count() - config_.window_us;
  *centre = event.t.count();
  return above[-1] >= since_us || above[0] >= since_us || above[1] >= since_us ||
         centre[-1] >= since_us || centre[1] >= since_us || below[-1] >= since_us ||
         below[0] >= since_us || below[1] >= since_us;
}

}  // namespace nightjar::sim
