#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

namespace nightjar::sim {

core::Time render_interval(const RendererConfig& config, double motion_px_s, core::Time time_step) {
  const double wanted_s =
      std::min(config.max_motion_px / std::max(motion_px_s, 1e-9), 1e-3 * config.max_interval_ms);
  // Rounded down, or it would be too late; but 5 ms are 5 ms.
  const core::Time wanted(static_cast<std::int64_t>(1e6 * wanted_s * (1 + 1e-12)));
  return std::max(time_step, wanted);
}

Simulation::Simulation(const WorldConfig& world, const CameraConfig& camera,
                       const SensorConfig& sensor, const std::filesystem::path& model_file,
                       double illuminance_lux, std::uint64_t seed)
    : renderer_config_(world.renderer),
      packet_interval_(core::from_seconds(1e-3 * camera.packet_interval_ms)),
      world_(world, camera, model_file, seed, sensor.imu),
      camera_(sensor, world_.camera_model().size, illuminance_lux, seed),
      drawing_thread_(world_.scene(), [this, illuminance_lux](const View& view, auto& picture) {
        world_.renderer().draw(view, illuminance_lux, picture);
      }) {
  if (packet_interval_ % world_.time_step() != core::Time(0))
    throw std::invalid_argument(
        fmt::format("camera.packet_interval_ms = {}, allowed multiples of the model's time step, "
                    "{} us",
                    camera.packet_interval_ms, world_.time_step().count()));
  look(world_.now());
}

void Simulation::look(core::Time t) {
  View view = drawing_thread_.blank_view();
  world_.look(t, view);
  drawing_thread_.add(t, std::move(view));
  drawn_late_ += motion_px_s_ * core::seconds(t - looked_) > renderer_config_.max_motion_px;
  motion_px_s_ = bounding_([this] { return world_.image_motion_px_s(); });
  looked_ = t;
  due_ = t + render_interval(renderer_config_, motion_px_s_, world_.time_step());
}

std::vector<core::StageTime> Simulation::stage_times() const {
  std::vector<core::StageTime> times = {moving_.time(), bounding_.time()};
  for (const auto& more : {drawing_thread_.stage_times(), camera_.stage_times()})
    times.insert(times.end(), more.begin(), more.end());
  return times;
}

void Simulation::fly(const core::AttitudeSetpoint& setpoint) {
  world_.command(setpoint);
  const core::Time packet_end = world_.now() + packet_interval_;
  while (world_.now() < packet_end) {
    const core::Time until = std::min(due_, packet_end);
    moving_([&] {
      while (world_.now() < until) world_.step();
    });
    if (due_ <= world_.now()) look(due_);
  }
  flown_.push_back({{}, {}, world_.take_imu(), world_.vehicle_state(), world_.truth()});
}

void Simulation::expose() {
  DrawingThread::Picture picture = drawing_thread_.take();
  camera_.expose(picture.t, picture.luminance_lux);
  exposed_ = picture.t;
  drawing_thread_.give_back(std::move(picture));
}

SimulationStep Simulation::take() {
  assert(!flown_.empty());
  SimulationStep step = std::move(flown_.front());
  flown_.pop_front();
  const core::Time end = step.truth.t;
  if (looked_ < end) look(world_.now());
  while (exposed_ < end) expose();
  CameraOutput camera = camera_.take(end);
  step.packet = std::move(camera.packet);
  step.frames = std::move(camera.frames);
  return step;
}

void Simulation::expose_looked() {
  while (exposed_ < looked_) expose();
}

SimulationStep Simulation::advance(const core::AttitudeSetpoint& setpoint) {
  fly(setpoint);
  return take();
}

}  // namespace nightjar::sim
