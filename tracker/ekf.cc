#include "tracker/ekf.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tracker/angles.h"

namespace nightjar::tracker {
namespace {

enum : int { kX, kY, kZ, kHeading, kSpeed, kTurnRate };

// Longer predictions go by steps of this length, over which the heading that
// the process noise is spread along hardly turns.
constexpr double kLongestStep_s = 0.02;

double sinc(double u) { return std::abs(u) < 1e-4 ? 1 - u * u / 6 : std::sin(u) / u; }

/// d sinc / d u.
double sinc_slope(double u) { return std::abs(u) < 1e-4 ? -u / 3 : (std::cos(u) - sinc(u)) / u; }

void predict_step(TargetState& x, TargetCovariance& P, double dt_s, const FilterConfig& config) {
  const TargetCovariance F = ctrv_jacobian(x, dt_s);
  P = F * P * F.transpose() + ctrv_process_noise(x[kHeading], dt_s, config);
  x = ctrv_predict(x, dt_s);
}

void predict_over(TargetState& x, TargetCovariance& P, double dt_s, const FilterConfig& config) {
  const int steps = static_cast<int>(std::ceil(dt_s / kLongestStep_s));
  for (int i = 0; i < steps; ++i) predict_step(x, P, dt_s / steps, config);
}

Eigen::Vector4d innovation(const TagFix& fix, const TargetState& x) {
  Eigen::Vector4d y = fix.z - x.head<4>();
  y[kHeading] = wrapped(y[kHeading]);
  return y;
}

}  // namespace

// Constant turn rate and velocity: the chord of an arc of angle w dt has the
// length v dt sinc(w dt / 2) and the direction of the arc's middle. This form
// of the textbook's v / w (sin(h + w dt) - sin h) is smooth through w = 0.
TargetState ctrv_predict(const TargetState& x, double dt_s) {
  const double half_rad = x[kTurnRate] * dt_s / 2;
  const double chord_m = x[kSpeed] * dt_s * sinc(half_rad);
  TargetState next = x;
  next[kX] += chord_m * std::cos(x[kHeading] + half_rad);
  next[kY] += chord_m * std::sin(x[kHeading] + half_rad);
  next[kHeading] = wrapped(x[kHeading] + 2 * half_rad);
  return next;
}

TargetCovariance ctrv_jacobian(const TargetState& x, double dt_s) {
  const double half_rad = x[kTurnRate] * dt_s / 2;
  const double c = std::cos(x[kHeading] + half_rad), s = std::sin(x[kHeading] + half_rad);
  const double by_speed_s = dt_s * sinc(half_rad);
  const double chord_m = x[kSpeed] * by_speed_s;
  const double stretch_m_s = x[kSpeed] * dt_s * sinc_slope(half_rad) * dt_s / 2;
  TargetCovariance F = TargetCovariance::Identity();
  F(kX, kHeading) = -chord_m * s;
  F(kY, kHeading) = chord_m * c;
  F(kX, kSpeed) = by_speed_s * c;
  F(kY, kSpeed) = by_speed_s * s;
  F(kX, kTurnRate) = stretch_m_s * c - chord_m * s * dt_s / 2;
  F(kY, kTurnRate) = stretch_m_s * s + chord_m * c * dt_s / 2;
  F(kHeading, kTurnRate) = dt_s;
  return F;
}

// White acceleration along the heading and white turn acceleration, integrated
// exactly over dt (Bar-Shalom, Estimation with Applications, 6.2.2).
TargetCovariance ctrv_process_noise(double heading_rad, double dt_s, const FilterConfig& config) {
  const double q_speed = config.speed_walk_m_s * config.speed_walk_m_s;
  const double q_turn = config.turn_rate_walk_rad_s * config.turn_rate_walk_rad_s;
  const double dt2 = dt_s * dt_s / 2, dt3 = dt_s * dt_s * dt_s / 3;
  const Eigen::Vector2d along(std::cos(heading_rad), std::sin(heading_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  TargetCovariance Q = TargetCovariance::Zero();
  Q.topLeftCorner<2, 2>() =
      q_speed * dt3 * along * along.transpose() +
      config.slip_walk_m * config.slip_walk_m * dt_s * across * across.transpose();
  Q.block<2, 1>(kX, kSpeed) = q_speed * dt2 * along;
  Q.block<1, 2>(kSpeed, kX) = q_speed * dt2 * along.transpose();
  Q(kSpeed, kSpeed) = q_speed * dt_s;
  Q(kZ, kZ) = config.height_walk_m * config.height_walk_m * dt_s;
  Q(kHeading, kHeading) = q_turn * dt3;
  Q(kHeading, kTurnRate) = Q(kTurnRate, kHeading) = q_turn * dt2;
  Q(kTurnRate, kTurnRate) = q_turn * dt_s;
  return Q;
}

TargetEkf::TargetEkf(const FilterConfig& config) : config_(config) {
  core::check_config(config_, "filter");
}

void TargetEkf::predict(core::Time t) {
  if (!started_ || t <= t_) return;
  if (core::seconds(t - last_fix_) > config_.coast_timeout_s) {
    started_ = false;
    return;
  }
  predict_over(x_, P_, core::seconds(t - t_), config_);
  t_ = t;
}

FixResult TargetEkf::update(std::span<const TagFix> alternatives) {
  if (alternatives.empty()) return FixResult::none;
  predict(alternatives.front().t);
  if (!started_) {
    start(alternatives);
    return FixResult::started;
  }
  const auto nearest = std::min_element(
      alternatives.begin(), alternatives.end(),
      [this](const TagFix& a, const TagFix& b) { return mahalanobis2(a) < mahalanobis2(b); });
  nis_ = mahalanobis2(*nearest);
  if (nis_ <= config_.gate_chi2) {
    fuse(*nearest);
    return FixResult::fused;
  }
  // An unconfirmed start may itself be the mistake.
  if (++gated_ < config_.restart_after_gated && fixes_ >= config_.confirm_fixes)
    return FixResult::gated;
  start(alternatives);
  return FixResult::restarted;
}

core::TargetEstimate TargetEkf::estimate_at(core::Time t) const {
  core::TargetEstimate estimate;
  estimate.t = t;
  TargetEkf copy = *this;
  copy.predict(t);
  if (!copy.started_) return estimate;
  const TargetState& x = copy.x_;
  estimate.valid = fixes_ >= config_.confirm_fixes;
  estimate.p_world_tag_m = x.head<3>();
  estimate.v_world_tag_m_s = {x[kSpeed] * std::cos(x[kHeading]), x[kSpeed] * std::sin(x[kHeading]),
                              0};
  estimate.heading_rad = x[kHeading];
  estimate.turn_rate_rad_s = x[kTurnRate];
  estimate.sigma_p_m = copy.P_.diagonal().head<3>().cwiseSqrt();
  estimate.last_tag = last_fix_;
  return estimate;
}

double TargetEkf::mahalanobis2(const TagFix& fix) const {
  const Eigen::Vector4d y = innovation(fix, x_);
  const Eigen::Matrix4d S = P_.topLeftCorner<4, 4>() + fix.R;
  return y.dot(S.ldlt().solve(y));
}

void TargetEkf::start(std::span<const TagFix> alternatives) {
  const TagFix& fix =
      *std::min_element(alternatives.begin(), alternatives.end(),
                        [](const TagFix& a, const TagFix& b) { return a.tilt_rad < b.tilt_rad; });
  started_ = true;
  t_ = last_fix_ = fix.t;
  fixes_ = 1;
  gated_ = 0;
  nis_ = 0;
  x_ << fix.z, 0, 0;
  P_.setZero();
  P_.topLeftCorner<4, 4>() = fix.R;
  P_(kSpeed, kSpeed) = config_.initial_speed_sigma_m_s * config_.initial_speed_sigma_m_s;
  P_(kTurnRate, kTurnRate) =
      config_.initial_turn_rate_sigma_rad_s * config_.initial_turn_rate_sigma_rad_s;
}

// H = [I4 0]; covariance in Joseph's form, which stays symmetric and positive.
void TargetEkf::fuse(const TagFix& fix) {
  const Eigen::Matrix4d S = P_.topLeftCorner<4, 4>() + fix.R;
  const Eigen::Matrix<double, 6, 4> K = S.ldlt().solve(P_.leftCols<4>().transpose()).transpose();
  TargetCovariance I_KH = TargetCovariance::Identity();
  I_KH.leftCols<4>() -= K;
  x_ += K * innovation(fix, x_);
  x_[kHeading] = wrapped(x_[kHeading]);
  P_ = I_KH * P_ * I_KH.transpose() + K * fix.R * K.transpose();
  last_fix_ = fix.t;
  ++fixes_;
  gated_ = 0;
}

}  // namespace nightjar::tracker
