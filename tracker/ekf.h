#pragma once

#include <Eigen/Core>
#include <span>

#include "core/state.h"
#include "tracker/config.h"
#include "tracker/tag_fix.h"

namespace nightjar::tracker {

/// State order of the target filter: position (m), heading (rad), speed along
/// the heading (m/s, negative backwards), turn rate (rad/s).
using TargetState = Eigen::Matrix<double, 6, 1>;
using TargetCovariance = Eigen::Matrix<double, 6, 6>;

/// The state after `dt_s` of constant speed and turn rate.
TargetState ctrv_predict(const TargetState& x, double dt_s);

/// d ctrv_predict / d x.
TargetCovariance ctrv_jacobian(const TargetState& x, double dt_s);

/// Covariance that the random walks of `config` add within `dt_s` at `heading_rad`.
TargetCovariance ctrv_process_noise(double heading_rad, double dt_s, const FilterConfig& config);

/// What became of the fixes of one picture.
enum class FixResult { none, started, fused, gated, restarted };

/// Extended Kalman filter of the UGV's motion over level ground.
///
/// It lives at the time of its last fix; asking for another time predicts a
/// copy. Position and heading are measured, speed and turn rate follow.
class TargetEkf {
 public:
  /// Throws std::invalid_argument for a config value out of range.
  explicit TargetEkf(const FilterConfig& config);

  /// Moves the filter on to `t`; earlier times and an unstarted filter are left
  /// alone. Drops the estimate once the last fix is older than the coast timeout.
  void predict(core::Time t);

  /// Takes the alternatives that one picture offers (the two pose solutions of
  /// each tag), all of one time: predicts to it and fuses the nearest by
  /// Mahalanobis distance, if it passes the gate. Starts on the most upright.
  FixResult update(std::span<const TagFix> alternatives);

  /// The estimate at `t`, predicted on a copy; not valid before enough fixes.
  core::TargetEstimate estimate_at(core::Time t) const;

  bool started() const { return started_; }
  core::Time time() const { return t_; }
  const TargetState& state() const { return x_; }
  const TargetCovariance& covariance() const { return P_; }

  /// Normalised innovation squared of the last fused or gated fix (4 dof).
  double nis() const { return nis_; }

 private:
  double mahalanobis2(const TagFix& fix) const;
  void start(std::span<const TagFix> alternatives);
  void fuse(const TagFix& fix);

  FilterConfig config_;
  bool started_ = false;
  core::Time t_{};
  core::Time last_fix_{};
  int fixes_ = 0;  // fused since the start
  int gated_ = 0;  // gated in a row
  double nis_ = 0;
  TargetState x_ = TargetState::Zero();
  TargetCovariance P_ = TargetCovariance::Identity();
};

}  // namespace nightjar::tracker
