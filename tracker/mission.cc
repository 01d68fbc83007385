#include "tracker/mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tracker/pause.h"

namespace nightjar::tracker {
namespace {

using core::MissionPhase;

// While landing the goal sinks this far below standing height: the pull that
// tells standing on the board from not having come down yet.
constexpr double kPressDepth_m = 0.25;
// Descending stops this far under the commit height, to hold there until the
// vehicle is well enough aligned to commit.
constexpr double kHoldBelowCommit = 0.95;

/// `value` moved towards `goal` by at most `step`.
double towards(double value, double goal, double step) {
  return value + std::clamp(goal - value, -step, step);
}

}  // namespace

FlightGoal extrapolate(const FlightGoal& goal, double dt_s) {
  FlightGoal next = goal;
  next.t += core::from_seconds(dt_s);
  next.p_world_m += goal.v_world_m_s * dt_s + goal.a_world_m_s2 * (dt_s * dt_s / 2);
  next.v_world_m_s += goal.a_world_m_s2 * dt_s;
  return next;
}

/// The vehicle as seen from the tag.
struct Mission::Relation {
  Relation(const core::VehicleState& vehicle, const core::TargetEstimate& target)
      : t(vehicle.t), valid(target.valid), tag_age_s(core::seconds(vehicle.t - target.last_tag)) {
    const Eigen::Vector3d p = vehicle.p_world_body_m - target.p_world_tag_m;
    const Eigen::Vector3d v = vehicle.v_world_body_m_s - target.v_world_tag_m_s;
    vehicle_z_m = vehicle.p_world_body_m.z();
    height_m = p.z();
    climb_m_s = v.z();
    error_m = p.head<2>().norm();
    drift_m_s = v.head<2>().norm();
  }

  core::Time t;
  bool valid;
  double tag_age_s;
  double vehicle_z_m;
  double height_m;  // above the tag
  double climb_m_s;
  double error_m;  // horizontal
  double drift_m_s;
};

Mission::Mission(const MissionConfig& config) : config_(config) {
  core::check_config(config_, "mission");
}

FlightGoal Mission::step(const core::VehicleState& vehicle, const core::TargetEstimate& target) {
  if (!begun_) {
    begun_ = last_step_ = phase_begun_ = vehicle.t;
    search_centre_m_.head<2>() = vehicle.p_world_body_m.head<2>();
    search_z_m_ = vehicle.p_world_body_m.z();
  }
  const core::Time since_last = vehicle.t - last_step_;
  if (since_last > kPause) held_since_.reset();
  const double dt_s = core::seconds(std::min(since_last, kPause));  // the goal must not jump
  last_step_ = vehicle.t;
  const Relation now(vehicle, target);
  decide(now);

  FlightGoal goal;
  if (phase_ == MissionPhase::search)
    goal = search_goal(vehicle, target, dt_s);
  else if (phase_ == MissionPhase::touched_down)
    goal.motors_on = false;
  else
    goal = follow_goal(target, now, dt_s);
  goal.t = vehicle.t;
  if (target.valid) goal.height_above_tag_m = now.height_m;
  return goal;
}

std::vector<core::MissionTransition> Mission::take_transitions() {
  return std::exchange(transitions_, {});
}

void Mission::decide(const Relation& now) {
  switch (phase_) {
    case MissionPhase::search:
      if (now.valid && now.tag_age_s <= config_.tag_fresh_s)
        go(now, MissionPhase::track,
           fmt::format("tag found, {:.2f} m below and {:.2f} m aside", now.height_m, now.error_m));
      return;
    case MissionPhase::track: return decide_track(now);
    case MissionPhase::descend: return decide_descend(now);
    case MissionPhase::land: return decide_land(now);
    case MissionPhase::touched_down: return;
  }
}

void Mission::decide_track(const Relation& now) {
  if (lost(now)) return;
  const double mission_s = core::seconds(now.t - *begun_);
  const bool aligned = mission_s >= config_.land_after_s && now.tag_age_s <= config_.tag_fresh_s &&
                       now.error_m <= config_.align_radius_m &&
                       now.drift_m_s <= config_.align_speed_m_s;
  if (held(aligned, now, config_.align_hold_s))
    go(now, MissionPhase::descend,
       fmt::format("landing allowed since {:.2f} s, aligned within {:.2f} m and {:.2f} m/s",
                   config_.land_after_s, now.error_m, now.drift_m_s));
}

void Mission::decide_descend(const Relation& now) {
  if (lost(now)) return;
  if (now.height_m <= config_.commit_height_m && now.error_m <= config_.commit_radius_m &&
      now.tag_age_s <= config_.tag_fresh_s)
    go(now, MissionPhase::land,
       fmt::format("committed at height {:.2f} m, {:.3f} m aside", now.height_m, now.error_m));
}

void Mission::decide_land(const Relation& now) {
  if (!now.valid) return go(now, MissionPhase::search, "the prediction ran out while landing");
  const double landing_s = core::seconds(now.t - phase_begun_);
  if (landing_s > config_.land_timeout_s)
    return go(now, MissionPhase::search,
              fmt::format("no touchdown within {:.2f} s, height {:.2f} m", config_.land_timeout_s,
                          now.height_m));
  const bool standing = goal_height_m_ < now.height_m &&
                        now.height_m <= config_.stand_height_m + config_.touchdown_reach_m &&
                        std::abs(now.climb_m_s) <= config_.touchdown_speed_m_s;
  if (held(standing, now, config_.touchdown_hold_s))
    go(now, MissionPhase::touched_down,
       fmt::format("height {:.3f} m and {:.3f} m/s for {:.2f} s though told to descend",
                   now.height_m, now.climb_m_s, config_.touchdown_hold_s));
}

bool Mission::lost(const Relation& now) {
  if (now.valid && now.tag_age_s <= config_.lost_after_s) return false;
  go(now, MissionPhase::search,
     now.valid ? fmt::format("no tag for {:.2f} s, height {:.2f} m", now.tag_age_s, now.height_m)
               : std::string("the estimate was dropped"));
  return true;
}

bool Mission::held(bool condition, const Relation& now, double hold_s) {
  if (!condition)
    held_since_.reset();
  else if (!held_since_)
    held_since_ = now.t;
  return held_since_ && core::seconds(now.t - *held_since_) >= hold_s;
}

void Mission::go(const Relation& now, MissionPhase to, std::string cause) {
  transitions_.push_back({.t = now.t, .from = phase_, .to = to, .cause = std::move(cause)});
  if (phase_ == MissionPhase::search) goal_height_m_ = now.height_m;
  // A goal that sank while landing must not pull the vehicle down once it is searching.
  if (to == MissionPhase::search) search_z_m_ = std::max(search_z_m_, now.vehicle_z_m);
  spiral_rad_ = 0;
  phase_ = to;
  phase_begun_ = now.t;
  held_since_.reset();
}

/// Climbs over the place where the tag should be, waits, then circles outwards.
FlightGoal Mission::search_goal(const core::VehicleState& vehicle,
                                const core::TargetEstimate& target, double dt_s) {
  FlightGoal goal;
  if (target.valid) {
    search_centre_m_ = target.p_world_tag_m;
    goal.v_world_m_s = target.v_world_tag_m_s;
  }
  search_z_m_ = towards(search_z_m_, search_centre_m_.z() + config_.search_height_m,
                        config_.climb_speed_m_s * dt_s);
  goal.p_world_m << search_centre_m_.head<2>(), search_z_m_;
  if (core::seconds(vehicle.t - phase_begun_) < config_.search_hold_s) return goal;

  // Archimedean spiral, the angle's rate bounded near the middle.
  const double pitch_m = config_.search_pitch_m / (2 * std::numbers::pi);
  const double radius_m = std::min(pitch_m * spiral_rad_, config_.search_radius_m);
  const double rate_rad_s = config_.search_speed_m_s / std::max(radius_m, config_.search_pitch_m);
  spiral_rad_ += rate_rad_s * dt_s;
  const Eigen::Vector3d out(std::cos(spiral_rad_), std::sin(spiral_rad_), 0);
  goal.p_world_m += radius_m * out;
  goal.v_world_m_s += radius_m * rate_rad_s * Eigen::Vector3d(-out.y(), out.x(), 0);
  return goal;
}

/// Over the tag, moving and turning with it.
FlightGoal Mission::follow_goal(const core::TargetEstimate& target, const Relation& now,
                                double dt_s) {
  const double rate_m_s = height_rate_m_s(now);
  goal_height_m_ += rate_m_s * dt_s;
  const Eigen::Vector3d v = target.v_world_tag_m_s;
  FlightGoal goal;
  goal.p_world_m = target.p_world_tag_m + Eigen::Vector3d(0, 0, goal_height_m_);
  goal.v_world_m_s = v + Eigen::Vector3d(0, 0, rate_m_s);
  goal.a_world_m_s2 = target.turn_rate_rad_s * Eigen::Vector3d(-v.y(), v.x(), 0);
  goal.heading_rad = target.heading_rad;
  search_z_m_ = goal.p_world_m.z();  // where a search would begin
  return goal;
}

/// How fast the goal's height above the tag changes now.
double Mission::height_rate_m_s(const Relation& now) const {
  switch (phase_) {
    case MissionPhase::track:
      // Exponentially, time constant 1 s, so that it arrives without a jerk.
      return std::clamp(config_.track_height_m - goal_height_m_, -config_.descend_speed_m_s,
                        config_.climb_speed_m_s);
    case MissionPhase::descend: {
      const bool in_cone = now.error_m <= config_.cone_radius_m + config_.cone_slope * now.height_m;
      const bool above = goal_height_m_ > kHoldBelowCommit * config_.commit_height_m;
      return in_cone && above && now.tag_age_s <= config_.tag_fresh_s ? -config_.descend_speed_m_s
                                                                      : 0;
    }
    case MissionPhase::land:
      return goal_height_m_ > config_.stand_height_m - kPressDepth_m ? -config_.land_speed_m_s : 0;
    default: return 0;
  }
}

}  // namespace nightjar::tracker
