#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/imu.h"
#include "core/random.h"
#include "sim/gauss_markov.h"
#include "sim/sensor_config.h"

namespace nightjar::sim {

/// From sample to sample: 1 kHz, as libcaer sets the DAVIS346 up.
inline constexpr core::Time kImuInterval{1000};

/// The camera at a moment: its attitude, and the velocity of its optical centre.
struct CameraMotion {
  Eigen::Quaterniond q_world_camera = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_world_camera_m_s = Eigen::Vector3d::Zero();
};

/// The inertial sensor inside the camera, at its optical centre and along its axes (the
/// real chip sits some millimetres off). It averages over each interval, as sensors that
/// integrate do. The rate is the turn over the interval, exact about a fixed axis; the
/// specific force is the change of velocity, in the axes of the interval's middle (wrong
/// by a share of 3e-6 at 500 deg/s).
///
/// White noise has the data sheet's one-sided density up to half the sample rate; the
/// chip's own low pass (184 Hz in libcaer's setting) is left out, so that single samples
/// deviate 1.6 times as much as the chip's, and come without its delay of 2 to 3 ms.
class Imu {
 public:
  /// `start` is the camera at time 0. Throws std::invalid_argument for a config out of
  /// range.
  Imu(const ImuConfig& config, const Eigen::Vector3d& gravity_world_m_s2, const CameraMotion& start,
      std::uint64_t seed);

  /// The sample at the end of the next interval, when the camera moves as `now` says.
  core::ImuSample next(const CameraMotion& now);

 private:
  /// One kind of the two sensors, all three axes, in its SI unit.
  struct Triad {
    Eigen::Vector3d read(const Eigen::Vector3d& truth, double dt_s);

    double range;
    double noise_sigma;
    core::Random noise;
    Eigen::Vector3d bias;
    GaussMarkov drift;
  };

  Eigen::Vector3d gravity_world_m_s2_;
  Triad gyro_;
  Triad accel_;
  core::Time t_{};
  CameraMotion last_;
};

}  // namespace nightjar::sim
