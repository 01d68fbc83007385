#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/truth.h"
#include "sim/simulated_camera.h"
#include "sim/world.h"

namespace nightjar::sim {

/// What the simulator hands out at the end of each packet.
struct SimulationStep {
  core::EventPacket packet;
  std::vector<core::ApsFrame> frames;
  core::VehicleState vehicle;  ///< the autopilot's estimate at packet.end
  core::Truth truth;           ///< at packet.end
};

/// The world seen through the event camera, packet by packet.
class Simulation {
 public:
  /// Throws std::invalid_argument for a bad config or model, among them a packet
  /// interval that is not a whole number of physics steps.
  Simulation(const WorldConfig& world, const CameraConfig& camera, const SensorConfig& sensor,
             const std::filesystem::path& model_file, double illuminance_lux, std::uint64_t seed);

  /// Flies under `setpoint` to the end of the next packet. A render comes as soon as
  /// a point of floor or landing board may have moved renderer.max_motion_px, in whole
  /// physics steps (docs/decisions/0002).
  SimulationStep advance(const core::AttitudeSetpoint& setpoint);

  const World& world() const { return world_; }
  World& world() { return world_; }
  const SimulatedCamera& camera() const { return camera_; }
  std::uint64_t renders() const { return renders_; }

 private:
  void render();
  /// When the next render is due, from the image motion now; at most `packet_end`.
  core::Time next_render(core::Time packet_end) const;

  RendererConfig renderer_config_;
  double illuminance_lux_;
  core::Time packet_interval_;
  World world_;
  SimulatedCamera camera_;
  core::Image<float> luminance_lux_;
  std::uint64_t renders_ = 0;
};

}  // namespace nightjar::sim
