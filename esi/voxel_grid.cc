#include "esi/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace nightjar::esi {

void fill_voxel_grid(std::span<const PackedEvent> events, core::Resolution sensor,
                     VoxelGrid& grid) {
  const auto plane = static_cast<std::size_t>(grid.size.pixels());
  grid.values.assign(plane * VoxelGrid::kBins, 0.0f);
  if (events.empty()) return;
  const std::uint32_t first_us = events.front().t_us;
  const std::uint32_t span_us = std::max(events.back().t_us - first_us, 1u);
  const double bins_per_us = (VoxelGrid::kBins - 1) / static_cast<double>(span_us);
  const auto sensor_width = static_cast<std::uint32_t>(sensor.width_px);
  const auto grid_width = static_cast<std::uint32_t>(grid.size.width_px);
  for (const PackedEvent& e : events) {
    const std::uint32_t pixel = e.pixel() / sensor_width * grid_width + e.pixel() % sensor_width;
    const double at = bins_per_us * (e.t_us - first_us);
    const int bin = std::min(static_cast<int>(at), VoxelGrid::kBins - 1);
    const auto later = static_cast<float>(at - bin);
    const float polarity = e.on() ? 1.0f : -1.0f;
    float* value = grid.values.data() + static_cast<std::size_t>(bin) * plane + pixel;
    *value += polarity * (1.0f - later);
    if (bin + 1 < VoxelGrid::kBins) value[plane] += polarity * later;
  }
}

void normalise(VoxelGrid& grid) {
  double sum = 0, sum_of_squares = 0;
  std::int64_t count = 0;
  for (const float value : grid.values) {
    sum += value;
    sum_of_squares += double{value} * value;
    count += value != 0;
  }
  if (count == 0) return;
  const double mean = sum / static_cast<double>(count);
  const double variance = sum_of_squares / static_cast<double>(count) - mean * mean;
  constexpr double kRounding = 1e-12;
  if (variance <= kRounding * mean * mean) return;
  const double scale = 1.0 / std::sqrt(variance);
  for (float& value : grid.values)
    if (value != 0) value = static_cast<float>((value - mean) * scale);
}

}  // namespace nightjar::esi
