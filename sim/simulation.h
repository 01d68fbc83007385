#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/imu.h"
#include "core/truth.h"
#include "sim/drawing_thread.h"
#include "sim/simulated_camera.h"
#include "sim/world.h"

namespace nightjar::sim {

/// What the simulator hands out at the end of each packet.
struct SimulationStep {
  core::EventPacket packet;
  std::vector<core::ApsFrame> frames;
  std::vector<core::ImuSample> imu;  ///< those of the packet's time
  core::VehicleState vehicle;        ///< the autopilot's estimate at packet.end
  core::Truth truth;                 ///< at packet.end
};

/// How long after one render the next is due, when what is in view moves at
/// `motion_px_s`: before it may have moved max_motion_px, but not before a physics step of
/// `time_step`.
core::Time render_interval(const RendererConfig& config, double motion_px_s, core::Time time_step);

/// The world seen through the event camera, packet by packet.
class Simulation {
 public:
  /// Throws std::invalid_argument for a bad config or model, among them a packet
  /// interval that is not a whole number of physics steps.
  Simulation(const WorldConfig& world, const CameraConfig& camera, const SensorConfig& sensor,
             const std::filesystem::path& model_file, double illuminance_lux, std::uint64_t seed);

  /// Flies under `setpoint` to the end of the next packet, looking after each
  /// render_interval() (docs/decisions/0002). What was seen is drawn on another thread
  /// meanwhile and afterwards (docs/decisions/0003).
  void fly(const core::AttitudeSetpoint& setpoint);

  /// What the earliest packet flown and not yet taken gave; there must be one. Exposes the
  /// camera to what was drawn, up to the first picture of the packet's end or later. If nothing
  /// has been looked at since that end, looks now: flying on before taking spares this picture.
  SimulationStep take();

  /// Exposes the camera to all that was looked at so far, once it is drawn: the next take() has
  /// less to do.
  void expose_looked();

  /// Flies one packet and takes it.
  SimulationStep advance(const core::AttitudeSetpoint& setpoint);

  const World& world() const { return world_; }
  World& world() { return world_; }
  /// The camera, to look at once every packet is taken.
  const SimulatedCamera& camera() const { return camera_; }
  std::uint64_t renders() const { return drawing_thread_.drawn(); }
  /// Of the intervals between them, those that were longer than max_motion_px asks: a physics
  /// step, the shortest there is.
  std::uint64_t drawn_late() const { return drawn_late_; }
  /// Of the world and of its camera.
  std::vector<core::StageTime> stage_times() const;

 private:
  /// Looks at time `t`, now or less than a physics step ago, and plans when to look again.
  void look(core::Time t);
  /// Exposes the camera to the next picture.
  void expose();

  RendererConfig renderer_config_;
  core::Time packet_interval_;
  World world_;
  SimulatedCamera camera_;
  core::Time looked_{}, due_{};        ///< The last look and the next.
  double motion_px_s_ = 0;             ///< At the last look.
  std::optional<core::Time> exposed_;  ///< The last picture's.
  std::deque<SimulationStep> flown_;   ///< Without what the camera gives.
  std::uint64_t drawn_late_ = 0;
  core::StageTimer moving_{"step physics", "loop"};
  core::StageTimer bounding_{"bound motion", "loop"};
  DrawingThread drawing_thread_;  // last: it uses the world's renderer
};

}  // namespace nightjar::sim
