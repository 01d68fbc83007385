#include "scenarios/scorer.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "scenarios/pass_criteria.h"
#include "scenarios/tag_score.h"

namespace nightjar::scenarios {

Scorer::Scorer(Setup setup) : setup_(std::move(setup)) {
  summary_.scenario = setup_.scenario;
  summary_.seed = setup_.seed;
}

void Scorer::add(const PictureRecord& record) {
  check_times(record);
  const TagScore tags = score_tags(setup_.camera, record.truth, setup_.tag, record.detections);
  PhaseCount& phase = phase_count(record.truth.course_phase);
  ++summary_.pictures;
  ++phase.pictures;
  summary_.detections += tags.detected;
  phase.detections += tags.detected;
  summary_.false_detections += tags.false_detections;
  score_estimate(record);
  hash_.add(record.estimate);
  last_ = record.truth;
  score_landing(record.truth);
}

void Scorer::add(const core::MissionTransition& transition) {
  summary_.transitions.push_back(transition);
  if (transition.to == core::MissionPhase::touched_down && !touched_down_)
    touched_down_ = transition.t;
  if (summary_.pictures > 0) score_landing(last_);
}

Summary Scorer::summary(core::Time end, double wall_time_s) const {
  Summary s = summary_;
  s.sim_time_s = core::seconds(end);
  s.wall_time_s = wall_time_s;
  s.real_time_factor = wall_time_s > 0 ? s.sim_time_s / wall_time_s : 0;
  if (s.pictures > 0)
    s.detection_rate = static_cast<double>(s.detections) / static_cast<double>(s.pictures);
  if (s.sim_time_s > 0) s.event_rate_hz = static_cast<double>(s.events) / s.sim_time_s;
  s.landed = touchdown_error_m_ && last_.on_board && !s.crashed;
  if (s.landed) s.touchdown_error_m = touchdown_error_m_;
  if (valid_estimates_ > 0)
    s.relative_position_rmse_m =
        std::sqrt(squared_error_sum_m2_ / static_cast<double>(valid_estimates_));
  s.estimates_sha256 = hash_.hex();
  s.failed_criteria = failed_criteria(setup_.criteria, s);
  s.passed = s.failed_criteria.empty();
  return s;
}

void Scorer::check_times(const PictureRecord& record) const {
  const core::Time t = record.truth.t;
  const auto check = [t](const char* part, core::Time part_t) {
    if (part_t != t)
      throw std::invalid_argument(
          fmt::format("{}.t = {} us, wanted the truth's {} us", part, part_t.count(), t.count()));
  };
  check("truth.uav", record.truth.uav.t);
  check("vehicle", record.vehicle.t);
  if (record.estimate.valid) check("estimate", record.estimate.t);
  for (const core::TagDetection& tag : record.detections) check("detection", tag.t);
  if (summary_.pictures > 0 && t < last_.t)
    throw std::invalid_argument(
        fmt::format("picture at {} us after one at {} us", t.count(), last_.t.count()));
}

PhaseCount& Scorer::phase_count(const std::string& course_phase) {
  if (course_phase == "straight") return summary_.straight;
  if (course_phase == "turning") return summary_.turning;
  if (course_phase == "landing") return summary_.landing;
  throw std::invalid_argument(
      fmt::format("course_phase = \"{}\", allowed straight, turning, landing", course_phase));
}

void Scorer::score_landing(const core::Truth& truth) {
  summary_.crashed |= truth.crashed;
  summary_.ugv_collided |= truth.ugv_collided;
  if (touchdown_error_m_ || !touched_down_ || truth.t < *touched_down_ || !truth.on_board) return;
  const Eigen::Vector3d offset_m = truth.uav.p_world_body_m - truth.T_world_tag.translation();
  touchdown_error_m_ = offset_m.head<2>().norm();
}

void Scorer::score_estimate(const PictureRecord& record) {
  if (!record.estimate.valid) return;
  const Eigen::Vector3d estimated_m = record.estimate.p_world_tag_m - record.vehicle.p_world_body_m;
  const Eigen::Vector3d true_m =
      record.truth.T_world_tag.translation() - record.truth.uav.p_world_body_m;
  squared_error_sum_m2_ += (estimated_m - true_m).squaredNorm();
  ++valid_estimates_;
}

}  // namespace nightjar::scenarios
