#include "scenarios/video_panes.h"

#include <algorithm>

namespace nightjar::scenarios {
namespace {

constexpr sim::Rgb kOn = {235, 60, 50}, kOff = {60, 190, 90}, kBackground = {14, 14, 18};

core::Resolution enlarged(core::Resolution sensor) {
  return {sensor.width_px * kPaneScale, sensor.height_px * kPaneScale};
}

void fill(Pane& pane, int x, int y, sim::Rgb colour) {
  for (int j = 0; j < kPaneScale; ++j)
    for (int i = 0; i < kPaneScale; ++i) pane(x * kPaneScale + i, y * kPaneScale + j) = colour;
}

}  // namespace

Pane gray_pane(const core::Image<std::uint8_t>& gray, core::Resolution sensor) {
  Pane pane(enlarged(sensor));
  if (gray.empty()) return pane;
  for (int y = 0; y < sensor.height_px; ++y)
    for (int x = 0; x < sensor.width_px; ++x)
      fill(pane, x, y, {gray(x, y), gray(x, y), gray(x, y)});
  return pane;
}

core::Image<std::uint8_t> gray_8_bit(const core::ApsFrame& frame) {
  core::Image<std::uint8_t> gray(frame.gray.size());
  std::ranges::transform(frame.gray.pixels(), gray.pixels().begin(), [&frame](std::uint16_t value) {
    return static_cast<std::uint8_t>(value >> (frame.bits - 8));
  });
  return gray;
}

Pane event_pane(std::span<const core::Event> events, core::Resolution sensor) {
  Pane pane(enlarged(sensor), kBackground);
  for (const core::Event& e : events) fill(pane, e.x, e.y, e.on ? kOn : kOff);
  return pane;
}

}  // namespace nightjar::scenarios
