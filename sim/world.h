#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera_model.h"
#include "core/truth.h"
#include "sim/autopilot.h"
#include "sim/chase_view.h"
#include "sim/config.h"
#include "sim/imu.h"
#include "sim/quadrotor.h"
#include "sim/renderer.h"
#include "sim/scene.h"
#include "sim/ugv.h"
#include "sim/view_motion.h"

namespace nightjar::sim {

/// UAV, UGV and arena: physics, inner loops and what a camera sees of them.
class World {
 public:
  /// Throws std::invalid_argument for a model that lacks a part or a time step that is
  /// not a whole number of microseconds and a whole part of kImuInterval.
  World(const WorldConfig& config, const CameraConfig& camera,
        const std::filesystem::path& model_file, std::uint64_t seed, const ImuConfig& imu = {});

  core::Time now() const { return now_; }
  core::Time time_step() const { return time_step_; }

  /// The setpoint that the autopilot holds from now on.
  void command(const core::AttitudeSetpoint& setpoint) { setpoint_ = setpoint; }

  /// Runs the physics for one time step.
  void step();

  /// The autopilot's estimate of the UAV, and what really is.
  const core::VehicleState& vehicle_state() const { return autopilot_.state(); }
  core::Truth truth() const;

  /// What the camera's inertial sensor felt since the last call.
  std::vector<core::ImuSample> take_imu() { return std::exchange(imu_samples_, {}); }

  /// Of the model, positive downwards.
  double gravity_m_s2() const;

  const core::CameraModel& camera_model() const { return camera_model_; }
  /// Where the camera sits on the UAV.
  Eigen::Isometry3d T_body_camera() const;

  /// An upper bound of the image motion (px/s) of all the camera sees at this moment.
  double image_motion_px_s() const;

  const Scene& scene() const { return scene_; }
  /// Draws what look() saw; not meant for others once DrawingThread has it.
  Renderer& renderer() { return renderer_; }
  /// What the UAV's camera saw at `t`, now or less than a time step ago, to be drawn by
  /// renderer().
  void look(core::Time t, View& view) { view.look(scene_, camera_, core::seconds(now_ - t)); }
  /// Both at once.
  void draw(double white_lux, core::Image<float>& luminance_lux) {
    renderer_.draw(scene_, camera_, white_lux, luminance_lux);
  }

  /// A colour view over both vehicles, from behind the UGV, in the size of `view`.
  void draw_chase(core::Image<Rgb>& view);

  const std::string& renderer_description() const { return renderer_.description(); }

 private:
  Eigen::Isometry3d T_world_camera() const;
  CameraMotion camera_motion() const;
  void place_vehicles(const WorldConfig& config);
  bool is_foot(int geom) const;
  /// On the board is a foot on the board; whatever else the UAV touches is a crash.
  void note_contacts();

  Scene scene_;
  Quadrotor quadrotor_;
  Autopilot autopilot_;
  Ugv ugv_;
  int camera_, tag_site_, board_geom_, ugv_body_;
  std::array<int, 4> foot_geoms_;
  core::CameraModel camera_model_;
  Renderer renderer_;
  std::optional<ChaseView> chase_;  ///< From the first draw_chase() on.
  ViewMotion view_motion_;
  core::Time time_step_;
  core::Time now_{};
  core::AttitudeSetpoint setpoint_;
  std::optional<Imu> imu_;  ///< From when the vehicles stand in their places.
  std::vector<core::ImuSample> imu_samples_;
  bool on_board_ = false, crashed_ = false, ugv_collided_ = false;
  double chase_azimuth_deg_ = 0;
  bool chase_started_ = false;
};

}  // namespace nightjar::sim
