#include <fmt/format.h>

#include <nightjar_lcm/attitude_setpoint_t.hpp>
#include <nightjar_lcm/imu_sample_t.hpp>
#include <nightjar_lcm/mission_transition_t.hpp>
#include <nightjar_lcm/tag_detections_t.hpp>
#include <nightjar_lcm/target_estimate_t.hpp>
#include <nightjar_lcm/truth_t.hpp>
#include <nightjar_lcm/vehicle_state_t.hpp>

#include "msg/convert.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

void put(const Eigen::Vector3d& v, double (&out)[3]) { Eigen::Map<Eigen::Vector3d>{out} = v; }

Eigen::Vector3d get(const double (&in)[3]) { return Eigen::Map<const Eigen::Vector3d>(in); }

// Never normalised on the way: that would change bits.
void put(const Eigen::Quaterniond& q, double (&wxyz)[4]) {
  wxyz[0] = q.w();
  wxyz[1] = q.x();
  wxyz[2] = q.y();
  wxyz[3] = q.z();
}

Eigen::Quaterniond get(const double (&wxyz)[4]) { return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}; }

using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

void put(const Eigen::Isometry3d& T, double (&rows)[3][4]) {
  Eigen::Map<Rows>{&rows[0][0]} = T.matrix().topRows<3>();
}

Eigen::Isometry3d get(const double (&rows)[3][4]) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.matrix().topRows<3>() = Eigen::Map<const Rows>(&rows[0][0]);
  return T;
}

core::MissionPhase phase_named(const std::string& name) {
  using enum core::MissionPhase;
  for (const core::MissionPhase phase : {search, track, descend, land, touched_down})
    if (name == core::to_string(phase)) return phase;
  throw std::invalid_argument(fmt::format(
      "mission_transition_t: phase = \"{}\", allowed search, track, descend, land, touched_down",
      name));
}

nightjar_lcm::tag_detection_t to_lcm(const core::TagDetection& tag) {
  nightjar_lcm::tag_detection_t message;
  message.id = tag.id;
  message.hamming = tag.hamming;
  message.decision_margin = tag.decision_margin;
  for (std::size_t i = 0; i < tag.corner_px.size(); ++i)
    for (int axis = 0; axis < 2; ++axis) message.corner_px[i][axis] = tag.corner_px[i][axis];
  return message;
}

core::TagDetection from_lcm(const nightjar_lcm::tag_detection_t& message, core::Time t) {
  core::TagDetection tag;
  tag.t = t;
  tag.id = message.id;
  tag.hamming = message.hamming;
  tag.decision_margin = message.decision_margin;
  for (std::size_t i = 0; i < tag.corner_px.size(); ++i)
    tag.corner_px[i] = {message.corner_px[i][0], message.corner_px[i][1]};
  return tag;
}

nightjar_lcm::vehicle_state_t to_lcm(const core::VehicleState& state) {
  nightjar_lcm::vehicle_state_t message;
  message.time_us = to_us(state.t);
  put(state.p_world_body_m, message.p_world_body_m);
  put(state.v_world_body_m_s, message.v_world_body_m_s);
  put(state.q_world_body, message.q_world_body_wxyz);
  put(state.omega_body_rad_s, message.omega_body_rad_s);
  return message;
}

core::VehicleState from_lcm(const nightjar_lcm::vehicle_state_t& message) {
  core::VehicleState state;
  state.t = core::Time(message.time_us);
  state.p_world_body_m = get(message.p_world_body_m);
  state.v_world_body_m_s = get(message.v_world_body_m_s);
  state.q_world_body = get(message.q_world_body_wxyz);
  state.omega_body_rad_s = get(message.omega_body_rad_s);
  return state;
}

}  // namespace

Bytes encode(const TagDetections& detections) {
  nightjar_lcm::tag_detections_t message;
  message.time_us = to_us(detections.t);
  message.n = static_cast<std::int32_t>(detections.tags.size());
  for (const core::TagDetection& tag : detections.tags) {
    if (tag.t != detections.t)
      throw std::invalid_argument(fmt::format("tag detections: tag at {} us, picture at {} us",
                                              tag.t.count(), detections.t.count()));
    message.tag.push_back(to_lcm(tag));
  }
  return to_bytes(message);
}

template <>
TagDetections decode(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8;               // fingerprint, time_us
  constexpr std::size_t kTagBytes = 4 + 4 + 8 + 4 * 2 * 8;  // id, hamming, margin, corners
  check_array_fits("tag_detections_t", bytes, kCountOffset, kTagBytes);
  const auto message = from_bytes<nightjar_lcm::tag_detections_t>(bytes);
  TagDetections detections{core::Time(message.time_us), {}};
  for (const auto& tag : message.tag) detections.tags.push_back(from_lcm(tag, detections.t));
  return detections;
}

Bytes encode(const core::TargetEstimate& estimate) {
  nightjar_lcm::target_estimate_t message;
  message.time_us = to_us(estimate.t);
  message.valid = estimate.valid;
  put(estimate.p_world_tag_m, message.p_world_tag_m);
  put(estimate.v_world_tag_m_s, message.v_world_tag_m_s);
  message.heading_rad = estimate.heading_rad;
  message.turn_rate_rad_s = estimate.turn_rate_rad_s;
  put(estimate.sigma_p_m, message.sigma_p_m);
  message.last_tag_us = to_us(estimate.last_tag);
  return to_bytes(message);
}

template <>
core::TargetEstimate decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::target_estimate_t>(bytes);
  core::TargetEstimate estimate;
  estimate.t = core::Time(message.time_us);
  estimate.valid = message.valid != 0;
  estimate.p_world_tag_m = get(message.p_world_tag_m);
  estimate.v_world_tag_m_s = get(message.v_world_tag_m_s);
  estimate.heading_rad = message.heading_rad;
  estimate.turn_rate_rad_s = message.turn_rate_rad_s;
  estimate.sigma_p_m = get(message.sigma_p_m);
  estimate.last_tag = core::Time(message.last_tag_us);
  return estimate;
}

Bytes encode(const core::VehicleState& state) { return to_bytes(to_lcm(state)); }

template <>
core::VehicleState decode(std::span<const std::uint8_t> bytes) {
  return from_lcm(from_bytes<nightjar_lcm::vehicle_state_t>(bytes));
}

Bytes encode(const core::ImuSample& sample) {
  nightjar_lcm::imu_sample_t message;
  message.time_us = to_us(sample.t);
  put(sample.omega_camera_rad_s, message.omega_camera_rad_s);
  put(sample.specific_force_camera_m_s2, message.specific_force_camera_m_s2);
  return to_bytes(message);
}

template <>
core::ImuSample decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::imu_sample_t>(bytes);
  return {core::Time(message.time_us), get(message.omega_camera_rad_s),
          get(message.specific_force_camera_m_s2)};
}

Bytes encode(const core::AttitudeSetpoint& setpoint) {
  nightjar_lcm::attitude_setpoint_t message;
  message.time_us = to_us(setpoint.t);
  put(setpoint.q_world_body, message.q_world_body_wxyz);
  message.thrust_m_s2 = setpoint.thrust_m_s2;
  message.motors_on = setpoint.motors_on;
  return to_bytes(message);
}

template <>
core::AttitudeSetpoint decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::attitude_setpoint_t>(bytes);
  return {core::Time(message.time_us), get(message.q_world_body_wxyz), message.thrust_m_s2,
          message.motors_on != 0};
}

Bytes encode(const core::MissionTransition& transition) {
  nightjar_lcm::mission_transition_t message;
  message.time_us = to_us(transition.t);
  message.from = core::to_string(transition.from);
  message.to = core::to_string(transition.to);
  message.cause = transition.cause;
  return to_bytes(message);
}

template <>
core::MissionTransition decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::mission_transition_t>(bytes);
  return {core::Time(message.time_us), phase_named(message.from), phase_named(message.to),
          message.cause};
}

Bytes encode(const core::Truth& truth) {
  nightjar_lcm::truth_t message;
  message.time_us = to_us(truth.t);
  message.uav = to_lcm(truth.uav);
  put(truth.T_world_camera, message.T_world_camera);
  put(truth.T_world_tag, message.T_world_tag);
  put(truth.v_world_tag_m_s, message.v_world_tag_m_s);
  message.turn_rate_rad_s = truth.turn_rate_rad_s;
  message.course_phase = truth.course_phase;
  message.on_board = truth.on_board;
  message.crashed = truth.crashed;
  message.ugv_collided = truth.ugv_collided;
  return to_bytes(message);
}

template <>
core::Truth decode(std::span<const std::uint8_t> bytes) {
  const auto message = from_bytes<nightjar_lcm::truth_t>(bytes);
  core::Truth truth;
  truth.t = core::Time(message.time_us);
  truth.uav = from_lcm(message.uav);
  truth.T_world_camera = get(message.T_world_camera);
  truth.T_world_tag = get(message.T_world_tag);
  truth.v_world_tag_m_s = get(message.v_world_tag_m_s);
  truth.turn_rate_rad_s = message.turn_rate_rad_s;
  truth.course_phase = message.course_phase;
  truth.on_board = message.on_board != 0;
  truth.crashed = message.crashed != 0;
  truth.ugv_collided = message.ugv_collided != 0;
  return truth;
}

}  // namespace nightjar::msg
