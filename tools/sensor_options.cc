#include "tools/sensor_options.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace nightjar::tools {
namespace {

std::optional<int> parse_side(std::string_view text) {
  int side_px = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, side_px);
  if (error != std::errc() || rest != end) return std::nullopt;
  return side_px >= 1 && side_px <= core::kMostSide_px ? std::optional(side_px) : std::nullopt;
}

}  // namespace

core::Resolution parse_size(const std::string& text) {
  const std::string_view view = text;
  if (const std::size_t x = view.find('x'); x != std::string_view::npos) {
    const auto width_px = parse_side(view.substr(0, x)), height_px = parse_side(view.substr(x + 1));
    if (width_px && height_px) return {*width_px, *height_px};
  }
  throw std::invalid_argument(
      fmt::format("--size = {}, expected WIDTHxHEIGHT as in 346x260, allowed 1 to {} each", text,
                  core::kMostSide_px));
}

sim::SensorPreset parse_preset(const std::string& name) {
  for (const auto& [each, preset] : sim::kSensorPresets)
    if (preset != sim::SensorPreset::custom && name == each) return preset;
  throw std::invalid_argument(fmt::format("--preset = {}, allowed {}", name, preset_names()));
}

std::string preset_names() {
  std::string names;
  for (const auto& [each, preset] : sim::kSensorPresets)
    if (preset != sim::SensorPreset::custom)
      names += (names.empty() ? "" : ", ") + std::string(each);
  return names;
}

}  // namespace nightjar::tools
