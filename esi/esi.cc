#include "esi/esi.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace nightjar::esi {
namespace {

[[noreturn]] void refuse(const core::Event& e, core::Resolution size, core::Time last) {
  if (e.t < last)
    throw std::invalid_argument("event at " + std::to_string(e.t.count()) + " us, allowed from " +
                                std::to_string(last.count()) + " us on");
  throw std::invalid_argument("event at (" + std::to_string(e.x) + ", " + std::to_string(e.y) +
                              "), allowed (0, 0) to (" + std::to_string(size.width_px - 1) + ", " +
                              std::to_string(size.height_px - 1) + ")");
}

}  // namespace

Esi::Esi(const EsiConfig& config, core::Resolution size) : config_(config), size_(size) {
  core::check_config(config, "esi");
  core::check_range("sensor.width_px", size.width_px, 1, 65535);
  core::check_range("sensor.height_px", size.height_px, 1, 65535);
  reset();
}

void Esi::reset() {
  cells_.assign(static_cast<std::size_t>(size_.pixels()), Cell{});
  last_ = core::Time{};
}

float Esi::decay(core::Time dt) const {
  const double left = std::max(1.0 - config_.decay_rate_hz * core::seconds(dt), 0.0);
  return static_cast<float>(config_.decay_power == 1.0 ? left
                                                       : std::pow(left, config_.decay_power));
}

void Esi::process(std::span<const core::Event> events) {
  const float step = static_cast<float>(config_.contrast_log);
  const float least = static_cast<float>(config_.least_log);
  const float greatest = static_cast<float>(config_.greatest_log);
  for (const core::Event& e : events) {
    if (e.t < last_ || e.x >= size_.width_px || e.y >= size_.height_px) refuse(e, size_, last_);
    last_ = e.t;
    Cell& cell =
        cells_[static_cast<std::size_t>(e.y) * static_cast<std::size_t>(size_.width_px) + e.x];
    const float added = cell.sum_log + (e.on ? step : -step);
    const float decayed = added * decay(core::Time(e.t.count() - cell.last_us));
    cell.last_us = e.t.count();
    cell.sum_log = std::clamp(decayed, least, greatest);
  }
}

void Esi::render(core::Time t, core::Picture& picture) {
  picture.t = t;
  if (picture.gray.size() != size_) picture.gray = core::Image<std::uint8_t>(size_);
  const float least = static_cast<float>(config_.least_log);
  const float scale = 255.0f / static_cast<float>(config_.greatest_log - config_.least_log);
  std::uint8_t* gray = picture.gray.pixels().data();
  for (const Cell& cell : cells_)  // eq. 14, rounded to the nearest level
    *gray++ = static_cast<std::uint8_t>((cell.sum_log - least) * scale + 0.5f);
}

}  // namespace nightjar::esi
