#include "sim/simulated_camera.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace nightjar::sim {
namespace {

/// Takes out those whose `time`, which grows from one to the next, is not after `end`.
template <class T, class Time>
std::vector<T> take_until(core::Time end, Time T::*time, std::vector<T>& all) {
  const auto later = std::ranges::upper_bound(all, end, {}, time);
  std::vector<T> taken(std::make_move_iterator(all.begin()), std::make_move_iterator(later));
  all.erase(all.begin(), later);
  return taken;
}

}  // namespace

SimulatedCamera::SimulatedCamera(const SensorConfig& config, core::Resolution size,
                                 double illuminance_lux, std::uint64_t seed)
    : emulator_(effective_pixel(config, illuminance_lux), size, illuminance_lux, seed),
      readout_(config.readout, size),
      filter_(config.background_activity_filter, size),
      aps_(config.aps, size, illuminance_lux, seed) {}

void SimulatedCamera::expose(core::Time t, const core::Image<float>& luminance_lux) {
  requests_.clear();
  emulating_([&] { emulator_.step(t, luminance_lux, requests_); });
  reading_out_([&] { readout_.step(t, requests_, events_); });
  if (auto frame = exposing_([&] { return aps_.add(t, luminance_lux); }))
    frames_.push_back(std::move(*frame));
  exposed_ = t;
}

CameraOutput SimulatedCamera::take(core::Time end) {
  assert(packet_begin_ <= end && end <= exposed_);
  CameraOutput output;
  output.packet = {std::exchange(packet_begin_, end), end,
                   take_until(end, &core::Event::t, events_)};
  filter_.filter(output.packet.events);
  output.frames = take_until(end, &core::ApsFrame::exposure_end, frames_);
  return output;
}

std::vector<core::StageTime> SimulatedCamera::stage_times() const {
  return {emulating_.time(), reading_out_.time(), exposing_.time()};
}

}  // namespace nightjar::sim
