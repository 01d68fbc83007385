#include "sim/simulated_camera.h"

#include <utility>

namespace nightjar::sim {

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
  now_ = t;
}

core::EventPacket SimulatedCamera::take_packet() {
  filter_.filter(events_);
  core::EventPacket packet{std::exchange(packet_begin_, now_), now_, std::move(events_)};
  events_.clear();
  return packet;
}

std::vector<core::StageTime> SimulatedCamera::stage_times() const {
  return {emulating_.time(), reading_out_.time(), exposing_.time()};
}

std::vector<core::ApsFrame> SimulatedCamera::take_frames() { return std::exchange(frames_, {}); }

}  // namespace nightjar::sim
