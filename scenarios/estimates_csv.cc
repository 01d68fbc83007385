#include "scenarios/estimates_csv.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <stdexcept>

namespace nightjar::scenarios {
namespace {

constexpr const char* kHeader =
    "time_us,course_phase,mission_phase,tags_decoded,"
    "true_p_world_uav_x_m,true_p_world_uav_y_m,true_p_world_uav_z_m,"
    "autopilot_p_world_uav_x_m,autopilot_p_world_uav_y_m,autopilot_p_world_uav_z_m,"
    "true_p_world_tag_x_m,true_p_world_tag_y_m,true_p_world_tag_z_m,"
    "true_v_world_tag_x_m_s,true_v_world_tag_y_m_s,true_v_world_tag_z_m_s,"
    "true_heading_rad,true_turn_rate_rad_s,"
    "estimate_valid,"
    "p_world_tag_x_m,p_world_tag_y_m,p_world_tag_z_m,"
    "v_world_tag_x_m_s,v_world_tag_y_m_s,v_world_tag_z_m_s,"
    "heading_rad,turn_rate_rad_s,"
    "sigma_p_x_m,sigma_p_y_m,sigma_p_z_m,last_tag_us\n";

// Whole micrometres and microradians: below what any estimate means.
std::string text(double value) { return fmt::format("{:.6f}", value); }

std::string text(const Eigen::Vector3d& v) {
  return fmt::format("{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
}

/// Direction of the tag's x axis about world z.
double heading_rad(const Eigen::Isometry3d& T_world_tag) {
  const Eigen::Matrix3d R = T_world_tag.linear();
  return std::atan2(R(1, 0), R(0, 0));
}

std::string estimate_columns(const core::TargetEstimate& estimate) {
  if (!estimate.valid) return "0,,,,,,,,,,,,";
  return fmt::format("1,{},{},{},{},{},{}", text(estimate.p_world_tag_m),
                     text(estimate.v_world_tag_m_s), text(estimate.heading_rad),
                     text(estimate.turn_rate_rad_s), text(estimate.sigma_p_m),
                     estimate.last_tag.count());
}

}  // namespace

EstimatesCsv::EstimatesCsv(OutputFolder& folder)
    : folder_(folder), out_(folder.part(kEstimatesFile), std::ios::binary) {
  if (!out_)
    throw std::runtime_error(
        fmt::format("{}: cannot be written", folder_.path(kEstimatesFile).string()));
  out_ << kHeader;
}

void EstimatesCsv::add(const PictureRecord& record) {
  const core::Truth& truth = record.truth;
  fmt::print(out_, "{},{},{},{},{},{},{},{},{},{},{}\n", truth.t.count(), truth.course_phase,
             core::to_string(record.mission_phase), record.detections.size(),
             text(truth.uav.p_world_body_m), text(record.vehicle.p_world_body_m),
             text(truth.T_world_tag.translation()), text(truth.v_world_tag_m_s),
             text(heading_rad(truth.T_world_tag)), text(truth.turn_rate_rad_s),
             estimate_columns(record.estimate));
}

void EstimatesCsv::finish() {
  out_.close();
  if (!out_)
    throw std::runtime_error(
        fmt::format("{}: cannot be written", folder_.path(kEstimatesFile).string()));
  folder_.complete(kEstimatesFile);
}

}  // namespace nightjar::scenarios
