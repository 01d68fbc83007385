#pragma once

#include <array>

#include "core/camera_model.h"
#include "scenarios/picture_record.h"

namespace nightjar::test {

/// A camera of the DAVIS346's size.
inline core::CameraModel davis_camera() {
  return {.size = {346, 260}, .fx_px = 300, .fy_px = 300, .cx_px = 172.5, .cy_px = 129.5};
}

inline constexpr double kTagSize_m = 0.24;

/// Where a tag 1.2 m below the camera of straight_below() is seen: half a side
/// is 0.12 m / 1.2 m * 300 px = 30 px. Bottom left, bottom right, top right, top left.
inline std::array<Eigen::Vector2d, 4> corners_straight_below() {
  return {{{142.5, 159.5}, {202.5, 159.5}, {202.5, 99.5}, {142.5, 99.5}}};
}

/// A UAV 1.2 m above a tag at (3, 2, 0.3) m that drives north, both with their
/// fronts to the north. The camera looks straight down, its picture's top edge
/// to the front; UAV body origin, camera and tag centre share one vertical.
inline core::Truth straight_below(core::Time t) {
  core::Truth truth;
  truth.t = truth.uav.t = t;
  Eigen::Matrix3d R_world_north;  // x forward = north, y left = west, z up
  R_world_north << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Eigen::Matrix3d R_world_camera;  // x right = east, y down = south, z forward = down
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  truth.T_world_tag.linear() = R_world_north;
  truth.T_world_tag.translation() << 3, 2, 0.3;
  truth.T_world_camera.linear() = R_world_camera;
  truth.T_world_camera.translation() << 3, 2, 1.5;
  truth.uav.p_world_body_m << 3, 2, 1.5;
  truth.uav.q_world_body = Eigen::Quaterniond(R_world_north);
  truth.v_world_tag_m_s << 0, 0.5, 0;
  truth.course_phase = "straight";
  return truth;
}

inline core::TagDetection tag_at(core::Time t, const std::array<Eigen::Vector2d, 4>& corner_px) {
  return {.t = t, .id = 0, .hamming = 0, .decision_margin = 50, .corner_px = corner_px};
}

/// The picture of straight_below() with nothing decoded and no valid estimate.
inline scenarios::PictureRecord blank_record(core::Time t) {
  scenarios::PictureRecord record;
  record.truth = straight_below(t);
  record.vehicle = record.truth.uav;
  record.estimate.t = t;
  record.mission_phase = core::MissionPhase::search;
  return record;
}

/// The same with the tag found where it is and an estimate that is right.
inline scenarios::PictureRecord perfect_record(core::Time t) {
  scenarios::PictureRecord record = blank_record(t);
  record.detections = {tag_at(t, corners_straight_below())};
  record.estimate.valid = true;
  record.estimate.p_world_tag_m = record.truth.T_world_tag.translation();
  record.estimate.v_world_tag_m_s = record.truth.v_world_tag_m_s;
  record.estimate.last_tag = t;
  record.mission_phase = core::MissionPhase::track;
  return record;
}

}  // namespace nightjar::test
