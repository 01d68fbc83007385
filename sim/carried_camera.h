#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/camera_model.h"
#include "core/image.h"
#include "core/truth.h"
#include "sim/carried_path.h"
#include "sim/config.h"
#include "sim/renderer.h"
#include "sim/scene.h"
#include "sim/simulated_camera.h"

namespace nightjar::sim {

/// What a carried camera gives at the end of a packet, and what it then saw.
struct CarriedStep {
  core::EventPacket packet;
  std::vector<core::ApsFrame> frames;
  core::Truth truth;                 ///< Poses of camera and tag at packet.end.
  core::Image<float> luminance_lux;  ///< At packet.end.
};

/// The scene's event camera carried by hand (CarriedPath) over its tag, both vehicles
/// at rest or held: for comparing what is made of the events, without a loop to close.
class CarriedCamera {
 public:
  /// `illuminance_lux`: of a white surface, 0.1 to 100,000. Throws std::invalid_argument for
  /// a value out of range or a bad model.
  CarriedCamera(const CameraConfig& camera, const SensorConfig& sensor,
                const RendererConfig& renderer, const std::filesystem::path& model_file,
                double illuminance_lux, CarryMotion motion, std::uint64_t seed);

  const core::CameraModel& model() const { return model_; }

  /// The next packet. Drawn before any point of the ground may have moved by
  /// max_motion_px since the picture before, and at the packet's end.
  CarriedStep next();

 private:
  Eigen::Isometry3d T_world_camera(core::Time t) const;
  double motion_px(core::Time from, core::Time to) const;
  core::Time next_render(core::Time packet_end) const;
  void render(core::Time t);

  RendererConfig renderer_config_;
  double illuminance_lux_;
  core::Time packet_interval_;
  Scene scene_;
  int camera_id_, tag_site_;
  core::CameraModel model_;
  Renderer renderer_;
  SimulatedCamera camera_;
  CarriedPath path_;
  Eigen::Isometry3d T_body_camera_;
  core::Time now_{};
  core::Image<float> luminance_lux_;
};

}  // namespace nightjar::sim
