#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <vector>

#include "core/imu.h"
#include "core/truth.h"
#include "sim/camera_thread.h"
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
/// `motion_px_s`: before it may have moved max_motion_px, in whole physics steps, at
/// least one.
core::Time render_interval(const RendererConfig& config, double motion_px_s, core::Time step);

/// The world seen through the event camera, packet by packet.
class Simulation {
 public:
  /// Throws std::invalid_argument for a bad config or model, among them a packet
  /// interval that is not a whole number of physics steps.
  Simulation(const WorldConfig& world, const CameraConfig& camera, const SensorConfig& sensor,
             const std::filesystem::path& model_file, double illuminance_lux, std::uint64_t seed);

  /// Flies under `setpoint` to the end of the next packet, looking after each
  /// render_interval() and at the packet's end (docs/decisions/0002). What was seen may
  /// still be drawn and exposed afterwards (docs/decisions/0003).
  void fly(const core::AttitudeSetpoint& setpoint);

  /// What the earliest packet flown and not yet taken gave; waits for the camera. May
  /// run beside fly() of the next packet. There must be such a packet: one whose fly()
  /// has returned.
  SimulationStep take();

  /// Both in one.
  SimulationStep advance(const core::AttitudeSetpoint& setpoint);

  const World& world() const { return world_; }
  World& world() { return world_; }
  /// The camera, to look at once every packet is taken.
  const SimulatedCamera& camera() const { return camera_; }
  std::uint64_t renders() const { return drawing_thread_.drawn(); }
  /// Of them, those that came later than max_motion_px asks, a physics step after the
  /// one before.
  std::uint64_t drawn_late() const { return drawn_late_; }
  /// Of the world and of its camera.
  std::vector<core::StageTime> stage_times() const;

 private:
  void look(bool ends_packet);
  /// Keeps what the world gives at the end of a packet.
  void note_world();

  RendererConfig renderer_config_;
  core::Time packet_interval_;
  World world_;
  SimulatedCamera camera_;
  std::uint64_t drawn_late_ = 0;
  core::StageTimer moving_{"step physics", "world"};
  core::StageTimer bounding_{"bound motion", "world"};
  core::StageTimer waiting_{"wait for camera", "handling"};
  std::mutex mutex_;
  std::deque<SimulationStep> flown_;  ///< Without what the camera gives; under mutex_.
  CameraThread camera_thread_;        // uses the camera
  DrawingThread drawing_thread_;      // last: it uses the world's renderer and the other thread
};

}  // namespace nightjar::sim
