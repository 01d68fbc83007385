#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace nightjar::sim {

Simulation::Simulation(const WorldConfig& world, const CameraConfig& camera,
                       const SensorConfig& sensor, const std::filesystem::path& model_file,
                       double illuminance_lux, std::uint64_t seed)
    : renderer_config_(world.renderer),
      illuminance_lux_(illuminance_lux),
      packet_interval_(core::from_seconds(1e-3 * camera.packet_interval_ms)),
      world_(world, camera, model_file, seed),
      camera_(sensor, world_.camera_model().size, illuminance_lux, seed) {
  if (packet_interval_ % world_.time_step() != core::Time(0))
    throw std::invalid_argument(
        fmt::format("camera.packet_interval_ms = {}, allowed multiples of the model's time step, "
                    "{} us",
                    camera.packet_interval_ms, world_.time_step().count()));
  render();
}

void Simulation::render() {
  world_.draw(illuminance_lux_, luminance_lux_);
  camera_.expose(world_.now(), luminance_lux_);
  ++renders_;
}

core::Time Simulation::next_render(core::Time packet_end) const {
  const double motion_px_s = world_.image_motion_px_s();
  const double wanted_s = std::min(renderer_config_.max_motion_px / std::max(motion_px_s, 1e-9),
                                   1e-3 * renderer_config_.max_interval_ms);
  const core::Time step = world_.time_step();
  const auto steps = std::max<std::int64_t>(1, core::from_seconds(wanted_s) / step);
  return std::min(packet_end, world_.now() + steps * step);
}

SimulationStep Simulation::advance(const core::AttitudeSetpoint& setpoint) {
  world_.command(setpoint);
  const core::Time packet_end = world_.now() + packet_interval_;
  while (world_.now() < packet_end) {
    const core::Time due = next_render(packet_end);
    while (world_.now() < due) world_.step();
    render();
  }
  return {camera_.take_packet(), camera_.take_frames(), world_.vehicle_state(), world_.truth()};
}

}  // namespace nightjar::sim
