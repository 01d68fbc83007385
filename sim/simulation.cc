#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

namespace nightjar::sim {

core::Time render_interval(const RendererConfig& config, double motion_px_s, core::Time step) {
  const double wanted_s =
      std::min(config.max_motion_px / std::max(motion_px_s, 1e-9), 1e-3 * config.max_interval_ms);
  // Rounded down, or it would be too late.
  const auto steps = static_cast<std::int64_t>(wanted_s / core::seconds(step) * (1 + 1e-12));
  return std::max<std::int64_t>(1, steps) * step;
}

Simulation::Simulation(const WorldConfig& world, const CameraConfig& camera,
                       const SensorConfig& sensor, const std::filesystem::path& model_file,
                       double illuminance_lux, std::uint64_t seed)
    : renderer_config_(world.renderer),
      packet_interval_(core::from_seconds(1e-3 * camera.packet_interval_ms)),
      world_(world, camera, model_file, seed, sensor.imu),
      camera_(sensor, world_.camera_model().size, illuminance_lux, seed),
      camera_thread_(camera_),
      drawing_thread_(world_.renderer(), world_.scene(), illuminance_lux, camera_thread_) {
  if (packet_interval_ % world_.time_step() != core::Time(0))
    throw std::invalid_argument(
        fmt::format("camera.packet_interval_ms = {}, allowed multiples of the model's time step, "
                    "{} us",
                    camera.packet_interval_ms, world_.time_step().count()));
  look(false);
}

void Simulation::look(bool ends_packet) {
  world_.look(drawing_thread_.next());
  drawing_thread_.draw(world_.now(), ends_packet);
}

std::vector<core::StageTime> Simulation::stage_times() const {
  std::vector<core::StageTime> times = {moving_.time(), bounding_.time(), waiting_.time()};
  for (const auto& more : {drawing_thread_.stage_times(), camera_.stage_times()})
    times.insert(times.end(), more.begin(), more.end());
  return times;
}

void Simulation::fly(const core::AttitudeSetpoint& setpoint) {
  world_.command(setpoint);
  const core::Time packet_end = world_.now() + packet_interval_;
  while (world_.now() < packet_end) {
    const core::Time before = world_.now();
    const double motion_px_s = bounding_([this] { return world_.image_motion_px_s(); });
    const core::Time due = std::min(
        packet_end, before + render_interval(renderer_config_, motion_px_s, world_.time_step()));
    moving_([&] {
      while (world_.now() < due) world_.step();
    });
    drawn_late_ += motion_px_s * core::seconds(due - before) > renderer_config_.max_motion_px;
    if (due == packet_end) note_world();  // before the camera can be done with the packet
    look(due == packet_end);
  }
}

void Simulation::note_world() {
  const std::lock_guard lock(mutex_);
  flown_.push_back({{}, {}, world_.take_imu(), world_.vehicle_state(), world_.truth()});
}

SimulationStep Simulation::take() {
  CameraOutput camera = waiting_([this] { return camera_thread_.take(); });
  const std::lock_guard lock(mutex_);
  assert(!flown_.empty());
  SimulationStep step = std::move(flown_.front());
  flown_.pop_front();
  step.packet = std::move(camera.packet);
  step.frames = std::move(camera.frames);
  return step;
}

SimulationStep Simulation::advance(const core::AttitudeSetpoint& setpoint) {
  fly(setpoint);
  return take();
}

}  // namespace nightjar::sim
