#pragma once

#include "core/config_check.h"

namespace nightjar::tracker {

/// Side of the median filter that takes single stray pixels out.
enum class Median { off, px3, px5 };
inline constexpr core::Choices<Median, 3> kMedianNames{
    {{"off", Median::off}, {"3x3", Median::px3}, {"5x5", Median::px5}}};

/// The printed tag and how AprilTag looks for it.
struct DetectorConfig {
  int tag_id = 0;                    ///< Of family 36h11.
  double tag_size_m = 0.24;          ///< Side of the black square, without the white border.
  int max_hamming = 2;               ///< Corrected bits at most.
  double min_decision_margin = 10;   ///< Grey levels between bits and their threshold.
  Median median = Median::px3;       ///< First smoothing step.
  double blur_sigma_px = 0.8;        ///< Gaussian blur after the median; 0: off.
  double quad_decimate = 1;          ///< Quads are sought in a picture this much smaller.
  bool refine_edges = true;          ///< Snap the quads' edges to the steepest gradient.
  double decode_sharpening = 0.25;   ///< Laplacian weight when bits are read.
  int min_white_black_diff = 5;      ///< Grey levels; less contrast counts as flat.
  double max_line_fit_mse_px2 = 10;  ///< Mean squared distance of edge points from their line.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("tag_id", tag_id, 0, 586);
    v.field("tag_size_m", tag_size_m, 0.01, 10.0);
    v.field("max_hamming", max_hamming, 0, 2);
    v.field("min_decision_margin", min_decision_margin, 0.0, 255.0);
    v.choice("median", median, kMedianNames);
    v.field("blur_sigma_px", blur_sigma_px, 0.0, 10.0);
    v.field("quad_decimate", quad_decimate, 1.0, 4.0);
    v.field("refine_edges", refine_edges);
    v.field("decode_sharpening", decode_sharpening, 0.0, 2.0);
    v.field("min_white_black_diff", min_white_black_diff, 1, 255);
    v.field("max_line_fit_mse_px2", max_line_fit_mse_px2, 0.1, 100.0);
  }
};

/// Where the detector looks while the filter knows about where the tag is.
struct WindowConfig {
  bool enabled = true;
  double margin_px = 24;            ///< Around the tag's predicted corners.
  double sigmas = 3;                ///< Of the predicted position, added to the margin.
  int full_frame_after_misses = 3;  ///< Pictures without a used tag in the window.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("enabled", enabled);
    v.field("margin_px", margin_px, 0.0, 1000.0);
    v.field("sigmas", sigmas, 0.0, 20.0);
    v.field("full_frame_after_misses", full_frame_after_misses, 1, 1000);
  }
};

/// How far one tag fix is trusted, as standard deviations.
struct MeasurementConfig {
  /// By how much the black square looks too small on each side. White spreads over black
  /// in sums of events: they count the logarithm, half of which is reached near black
  /// (0.24 px), and a black pixel answers slowly in the dark. A scenario file that does not
  /// say it gets another with reconstructor.method esi_net.
  double corner_inset_px = 0.4;
  double corner_noise_px = 0.5;      ///< Per corner and axis.
  double attitude_noise_rad = 0.01;  ///< Of the UAV's attitude: acts times the range.
  double position_noise_m = 0.01;    ///< Of the UAV's own position, per axis.
  double heading_noise_rad = 0.02;   ///< Of the UAV's yaw and the tag's mounting.
  double max_tag_tilt_rad = 0.5;     ///< Normals further from vertical are not believed.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("corner_inset_px", corner_inset_px, -5.0, 5.0,
            core::Origin{"measured on esi's pictures in 5 lux; -0.2 with esi_net"});
    v.field("corner_noise_px", corner_noise_px, 0.01, 20.0);
    v.field("attitude_noise_rad", attitude_noise_rad, 0.0, 0.5);
    v.field("position_noise_m", position_noise_m, 0.0, 1.0);
    v.field("heading_noise_rad", heading_noise_rad, 0.0, 1.0);
    v.field("max_tag_tilt_rad", max_tag_tilt_rad, 0.0, 1.57);
  }
};

/// The UGV's motion model. Walks are random walks: the standard deviation
/// gained within one second, growing with the square root of time.
struct FilterConfig {
  double speed_walk_m_s = 0.15;
  double turn_rate_walk_rad_s = 0.4;
  double slip_walk_m = 0.01;  ///< Sideways.
  double height_walk_m = 0.01;
  double initial_speed_sigma_m_s = 0.5;
  double initial_turn_rate_sigma_rad_s = 0.4;
  double gate_chi2 = 18.5;      ///< 4 degrees of freedom, 99.9 %.
  int confirm_fixes = 3;        ///< Accepted in a row before the estimate is valid.
  int restart_after_gated = 5;  ///< Gated in a row before starting anew.
  double coast_timeout_s = 4;   ///< Without a fix, then the estimate is dropped.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("speed_walk_m_s", speed_walk_m_s, 0.0, 20.0);
    v.field("turn_rate_walk_rad_s", turn_rate_walk_rad_s, 0.0, 20.0);
    v.field("slip_walk_m", slip_walk_m, 0.0, 5.0);
    v.field("height_walk_m", height_walk_m, 0.0, 5.0);
    v.field("initial_speed_sigma_m_s", initial_speed_sigma_m_s, 0.0, 20.0);
    v.field("initial_turn_rate_sigma_rad_s", initial_turn_rate_sigma_rad_s, 0.0, 20.0);
    v.field("gate_chi2", gate_chi2, 1.0, 1000.0);
    v.field("confirm_fixes", confirm_fixes, 1, 100);
    v.field("restart_after_gated", restart_after_gated, 1, 1000);
    v.field("coast_timeout_s", coast_timeout_s, 0.0, 60.0);
  }
};

/// When the mission goes from one phase to the next, and what it flies in each.
/// Heights are of the UAV's body origin above the tag unless said otherwise.
struct MissionConfig {
  double search_height_m = 2.0;   ///< Above the last known tag, or world zero.
  double search_hold_s = 3.0;     ///< Waits this long before it flies the spiral.
  double search_speed_m_s = 0.5;  ///< Along the spiral.
  double search_pitch_m = 0.6;    ///< Between two rounds of the spiral.
  double search_radius_m = 3.0;   ///< Largest radius.
  double track_height_m = 1.5;
  double land_after_s = 40;       ///< Mission time when landing is allowed.
  double align_radius_m = 0.15;   ///< Horizontal error that lets the descent begin,
  double align_speed_m_s = 0.25;  ///< relative horizontal speed, too,
  double align_hold_s = 0.5;      ///< both held for this long.
  double tag_fresh_s = 0.25;      ///< A tag this recent counts as seen.
  double lost_after_s = 1.5;      ///< Track and descend coast this long without a tag.
  double climb_speed_m_s = 0.4;
  double descend_speed_m_s = 0.25;
  double cone_radius_m = 0.06;    ///< Descends while the horizontal error is below
  double cone_slope = 0.12;       ///< cone_radius_m + cone_slope * height.
  double commit_height_m = 0.40;  ///< Below it nothing but a timeout stops the landing.
  double commit_radius_m = 0.08;  ///< Horizontal error allowed when committing.
  double land_speed_m_s = 0.5;
  double land_timeout_s = 3.5;        ///< Without touchdown: gives up and climbs.
  double stand_height_m = 0.10;       ///< Body origin above the tag when it stands on it.
  double touchdown_reach_m = 0.06;    ///< Height above stand_height_m that may be contact.
  double touchdown_speed_m_s = 0.08;  ///< Vertical speed that counts as none.
  double touchdown_hold_s = 0.15;     ///< Contact must last this long.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("search_height_m", search_height_m, 0.1, 50.0);
    v.field("search_hold_s", search_hold_s, 0.0, 600.0);
    v.field("search_speed_m_s", search_speed_m_s, 0.0, 10.0);
    v.field("search_pitch_m", search_pitch_m, 0.01, 50.0);
    v.field("search_radius_m", search_radius_m, 0.0, 100.0);
    v.field("track_height_m", track_height_m, 0.1, 50.0);
    v.field("land_after_s", land_after_s, 0.0, 3600.0);
    v.field("align_radius_m", align_radius_m, 0.0, 5.0);
    v.field("align_speed_m_s", align_speed_m_s, 0.0, 5.0);
    v.field("align_hold_s", align_hold_s, 0.0, 60.0);
    v.field("tag_fresh_s", tag_fresh_s, 0.0, 10.0);
    v.field("lost_after_s", lost_after_s, 0.0, 60.0);
    v.field("climb_speed_m_s", climb_speed_m_s, 0.01, 5.0);
    v.field("descend_speed_m_s", descend_speed_m_s, 0.01, 5.0);
    v.field("cone_radius_m", cone_radius_m, 0.0, 5.0);
    v.field("cone_slope", cone_slope, 0.0, 5.0);
    v.field("commit_height_m", commit_height_m, 0.0, 10.0);
    v.field("commit_radius_m", commit_radius_m, 0.0, 5.0);
    v.field("land_speed_m_s", land_speed_m_s, 0.01, 5.0);
    v.field("land_timeout_s", land_timeout_s, 0.1, 60.0);
    v.field("stand_height_m", stand_height_m, 0.0, 2.0);
    v.field("touchdown_reach_m", touchdown_reach_m, 0.0, 1.0);
    v.field("touchdown_speed_m_s", touchdown_speed_m_s, 0.0, 2.0);
    v.field("touchdown_hold_s", touchdown_hold_s, 0.0, 5.0);
  }
};

/// Cascade from position to attitude, and the dither that keeps edges moving
/// over the event pixels.
struct ControllerConfig {
  double position_gain_hz = 1.2;       ///< m/s per m.
  double velocity_gain_hz = 2.5;       ///< m/s^2 per m/s.
  double velocity_integral_hz2 = 1.2;  ///< m/s^2 per m.
  double max_integral_m_s2 = 1.5;
  double max_speed_m_s = 2.0;  ///< Horizontal correction, on top of feed-forward.
  double max_climb_m_s = 1.0;  ///< Vertical correction, up or down.
  double max_tilt_deg = 25;
  double min_thrust_m_s2 = 3;
  double max_thrust_m_s2 = 18;
  double max_yaw_rate_rad_s = 1.0;
  double dither_tilt_deg = 1.5;  ///< Half-angle of the cone; 0: off.
  double dither_rate_hz = 0.8;
  double dither_taper_height_m = 0.5;  ///< Below it the cone shrinks in proportion.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("position_gain_hz", position_gain_hz, 0.0, 20.0);
    v.field("velocity_gain_hz", velocity_gain_hz, 0.0, 50.0);
    v.field("velocity_integral_hz2", velocity_integral_hz2, 0.0, 50.0);
    v.field("max_integral_m_s2", max_integral_m_s2, 0.0, 10.0);
    v.field("max_speed_m_s", max_speed_m_s, 0.0, 20.0);
    v.field("max_climb_m_s", max_climb_m_s, 0.0, 10.0);
    v.field("max_tilt_deg", max_tilt_deg, 1.0, 60.0);
    v.field("min_thrust_m_s2", min_thrust_m_s2, 0.0, 9.0);
    v.field("max_thrust_m_s2", max_thrust_m_s2, 10.0, 100.0);
    v.field("max_yaw_rate_rad_s", max_yaw_rate_rad_s, 0.0, 10.0);
    v.field("dither_tilt_deg", dither_tilt_deg, 0.0, 10.0);
    v.field("dither_rate_hz", dither_rate_hz, 0.0, 20.0);
    v.field("dither_taper_height_m", dither_taper_height_m, 0.0, 10.0);
  }
};

/// Everything the companion computer can be told.
struct TrackerConfig {
  /// A picture shows the world as it was this long before. In 5 lux the error of the
  /// tracked position is least, and flat, between 0 and 10 ms and grows from 20 ms on.
  double picture_delay_ms = 10;
  double command_delay_ms = 10;   ///< From the picture until a setpoint acts.
  double max_state_age_ms = 100;  ///< A picture whose last vehicle state is older is refused.
  DetectorConfig detector;
  WindowConfig window;
  MeasurementConfig measurement;
  FilterConfig filter;
  MissionConfig mission;
  ControllerConfig controller;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("picture_delay_ms", picture_delay_ms, 0.0, 200.0);
    v.field("command_delay_ms", command_delay_ms, 0.0, 200.0);
    v.field("max_state_age_ms", max_state_age_ms, 0.0, 500.0);
    v.section("detector", detector);
    v.section("window", window);
    v.section("measurement", measurement);
    v.section("filter", filter);
    v.section("mission", mission);
    v.section("controller", controller);
  }
};

}  // namespace nightjar::tracker
