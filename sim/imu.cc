#include "sim/imu.h"

#include <cmath>
#include <numbers>
#include <string>

namespace nightjar::sim {
namespace {

constexpr double kRad = std::numbers::pi / 180;  // of a degree
constexpr double kG_m_s2 = 9.80665;              // standard gravity, the data sheet's g
constexpr double kCodes = 32768;                 // 16 bits, signed

/// Deviation of the mean over one interval of white noise with a one-sided density.
double white_sigma(double density) { return density / std::sqrt(2 * core::seconds(kImuInterval)); }

Eigen::Vector3d drawn_bias(double sigma, std::uint64_t seed, const std::string& name) {
  core::Random random = core::random_stream(seed, name);
  return sigma * normal3(random);
}

GaussMarkov drift(double sigma, double correlation_s, std::uint64_t seed, const std::string& name) {
  return {Eigen::Vector3d::Constant(sigma), correlation_s, core::random_stream(seed, name)};
}

/// Mean angular velocity of the turn from `a` to `b`, in the turning frame's own axes.
Eigen::Vector3d mean_rate_rad_s(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b,
                                double dt_s) {
  Eigen::Quaterniond turn = a.conjugate() * b;
  if (turn.w() < 0) turn.coeffs() *= -1;  // the short way round
  const double sine = turn.vec().norm();
  const double angle_by_sine = sine > 0 ? 2 * std::atan2(sine, turn.w()) / sine : 2.0;
  return turn.vec() * (angle_by_sine / dt_s);
}

}  // namespace

Eigen::Vector3d Imu::Triad::read(const Eigen::Vector3d& truth, double dt_s) {
  drift.advance(dt_s);
  const Eigen::Vector3d felt = truth + bias + drift.value() + noise_sigma * normal3(noise);
  const double unit = range / kCodes;
  return (felt / unit).array().round().max(-kCodes).min(kCodes - 1) * unit;
}

Imu::Imu(const ImuConfig& c, const Eigen::Vector3d& gravity_world_m_s2, const CameraMotion& start,
         std::uint64_t seed)
    : gravity_world_m_s2_(gravity_world_m_s2),
      gyro_{kRad * c.gyro_range_deg_s, white_sigma(kRad * c.gyro_noise_deg_s_sqrt_hz),
            core::random_stream(seed, "imu.gyro_noise"),
            drawn_bias(kRad * c.gyro_bias_sigma_deg_s, seed, "imu.gyro_bias"),
            drift(kRad * c.gyro_drift_sigma_deg_s, c.drift_correlation_s, seed, "imu.gyro_drift")},
      accel_{kG_m_s2 * c.accel_range_g, white_sigma(1e-6 * kG_m_s2 * c.accel_noise_ug_sqrt_hz),
             core::random_stream(seed, "imu.accel_noise"),
             drawn_bias(1e-3 * kG_m_s2 * c.accel_bias_sigma_mg, seed, "imu.accel_bias"),
             drift(1e-3 * kG_m_s2 * c.accel_drift_sigma_mg, c.drift_correlation_s, seed,
                   "imu.accel_drift")},
      last_(start) {
  core::check_config(c, "imu");
}

core::ImuSample Imu::next(const CameraMotion& now) {
  const double dt_s = core::seconds(kImuInterval);
  const Eigen::Vector3d acceleration_m_s2 =
      (now.v_world_camera_m_s - last_.v_world_camera_m_s) / dt_s;
  const Eigen::Quaterniond q_camera_world =
      last_.q_world_camera.slerp(0.5, now.q_world_camera).conjugate();  // at the interval's middle
  core::ImuSample sample;
  sample.t = t_ += kImuInterval;
  sample.omega_camera_rad_s =
      gyro_.read(mean_rate_rad_s(last_.q_world_camera, now.q_world_camera, dt_s), dt_s);
  sample.specific_force_camera_m_s2 =
      accel_.read(q_camera_world * (acceleration_m_s2 - gravity_world_m_s2_), dt_s);
  last_ = now;
  return sample;
}

}  // namespace nightjar::sim
