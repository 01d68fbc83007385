#pragma once

#include <array>
#include <vector>

#include "core/config_check.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// Rotors and drag of the UAV; mass, inertia and rotor places are in the MJCF.
struct QuadrotorConfig {
  double max_rotor_thrust_n = 7.0;      ///< Of one rotor at full speed.
  double motor_time_constant_s = 0.03;  ///< First-order lag of the rotor speed.
  double drag_xy_n_s_m = 0.25;          ///< Linear drag along body x and y.
  double drag_z_n_s_m = 0.35;           ///< Linear drag along body z.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("max_rotor_thrust_n", max_rotor_thrust_n, 0.5, 100.0);
    v.field("motor_time_constant_s", motor_time_constant_s, 0.001, 0.5);
    v.field("drag_xy_n_s_m", drag_xy_n_s_m, 0.0, 10.0);
    v.field("drag_z_n_s_m", drag_z_n_s_m, 0.0, 10.0);
  }
};

/// The autopilot: its state estimate is truth plus stationary first-order
/// Gauss-Markov errors (an assumption, of the size that a small UAV's filter with
/// indoor positioning reports), its inner loops hold attitude and body rates.
struct AutopilotConfig {
  double position_sigma_m = 0.03;
  double position_correlation_s = 10.0;
  double velocity_sigma_m_s = 0.03;
  double velocity_correlation_s = 1.0;
  double tilt_sigma_deg = 0.3;  ///< Roll and pitch, each.
  double heading_sigma_deg = 1.0;
  double attitude_correlation_s = 5.0;
  double rate_sigma_rad_s = 0.01;   ///< White, per step of the inner loop.
  double attitude_gain_1_s = 10.0;  ///< Attitude error to body rate.
  double rate_gain_1_s = 20.0;      ///< Body rate error to angular acceleration.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("position_sigma_m", position_sigma_m, 0.0, 5.0);
    v.field("position_correlation_s", position_correlation_s, 0.01, 1000.0);
    v.field("velocity_sigma_m_s", velocity_sigma_m_s, 0.0, 5.0);
    v.field("velocity_correlation_s", velocity_correlation_s, 0.01, 1000.0);
    v.field("tilt_sigma_deg", tilt_sigma_deg, 0.0, 20.0);
    v.field("heading_sigma_deg", heading_sigma_deg, 0.0, 45.0);
    v.field("attitude_correlation_s", attitude_correlation_s, 0.01, 1000.0);
    v.field("rate_sigma_rad_s", rate_sigma_rad_s, 0.0, 1.0);
    v.field("attitude_gain_1_s", attitude_gain_1_s, 0.5, 40.0);
    v.field("rate_gain_1_s", rate_gain_1_s, 1.0, 100.0);
  }
};

/// What the UGV does on a leg; results are counted by it.
enum class CoursePhase { straight, turning, landing };

inline constexpr core::Choices<CoursePhase, 3> kCoursePhases = {{
    {"straight", CoursePhase::straight},
    {"turning", CoursePhase::turning},
    {"landing", CoursePhase::landing},
}};

/// A point of the UGV's course; speed and phase hold on the leg that leaves it.
struct Waypoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double speed_m_s = 0.4;
  CoursePhase phase = CoursePhase::straight;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("x_m", x_m, -100.0, 100.0);
    v.field("y_m", y_m, -100.0, 100.0);
    v.field("speed_m_s", speed_m_s, 0.0, 5.0);
    v.choice("phase", phase, kCoursePhases);
  }
};

/// The UGV drives its course by pure pursuit and stops at the last waypoint. It
/// starts at the first one, heading for the second.
struct UgvConfig {
  double lookahead_m = 0.5;
  double max_acceleration_m_s2 = 0.5;
  std::vector<Waypoint> course = {{0, 0, 0.4, CoursePhase::straight},
                                  {5, 0, 0.4, CoursePhase::straight}};

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("lookahead_m", lookahead_m, 0.05, 5.0);
    v.field("max_acceleration_m_s2", max_acceleration_m_s2, 0.05, 10.0);
    v.list("course", course, 2, 1000);
  }
};

/// When and how finely the event camera's world is drawn.
struct RendererConfig {
  /// Samples along each side of a pixel (box filter). Textures are filtered as they
  /// are drawn, the tag and all edges on the landing board among them; what 1 leaves
  /// jagged are the outlines of bodies.
  int supersampling = 1;
  double max_motion_px = 0.5;    ///< Between two renders (ESIM, Rebecq et al. 2018).
  double max_interval_ms = 5.0;  ///< Even if nothing moves.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("supersampling", supersampling, 1, 4);
    v.field("max_motion_px", max_motion_px, 0.05, 20.0);
    v.field("max_interval_ms", max_interval_ms, 1.0, 100.0);
  }
};

/// The world but for the sensor. `start_from_tag_m`: where the UAV hovers at time
/// 0, from the tag's centre, in world axes.
struct WorldConfig {
  std::array<double, 3> start_from_tag_m = {-0.25, 0.15, 1.5};
  QuadrotorConfig quadrotor;
  AutopilotConfig autopilot;
  UgvConfig ugv;
  RendererConfig renderer;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("start_from_tag_m", start_from_tag_m, -50.0, 50.0);
    v.section("quadrotor", quadrotor);
    v.section("autopilot", autopilot);
    v.section("ugv", ugv);
    v.section("renderer", renderer);
  }
};

/// Resolution and view of the camera; the lens is an ideal pinhole.
struct CameraConfig {
  int width_px = 346;
  int height_px = 260;
  double fovy_deg = 47.3;            ///< 346x260: f = 296.9 px, a 5.5 mm lens on 18.5 um pixels.
  double packet_interval_ms = 10.0;  ///< Events come in packets of this length.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("width_px", width_px, 16, 2048, {"DAVIS346"});
    v.field("height_px", height_px, 16, 2048, {"DAVIS346"});
    v.field("fovy_deg", fovy_deg, 5.0, 150.0, {"assumption: 5.5 mm lens on 18.5 um pixels"});
    v.field("packet_interval_ms", packet_interval_ms, 1.0, 100.0, {"ESI paper; libcaer's default"});
  }
};

}  // namespace nightjar::sim
