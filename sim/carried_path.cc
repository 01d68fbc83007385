#include "sim/carried_path.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace nightjar::sim {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRad = std::numbers::pi / 180;

/// Root mean square and band of one axis.
struct Swing {
  double rms;
  double least_hz;
  double greatest_hz;
};

/// x and y (m), height (m), roll and pitch (rad), yaw (rad).
struct Swings {
  Swing place, height, tilt, yaw;
};

Swings swings(CarryMotion motion) {
  switch (motion) {
    case CarryMotion::slow:
      return {{0.09, 0.2, 0.5}, {0.06, 0.1, 0.3}, {0.7 * kRad, 0.3, 1.0}, {10 * kRad, 0.1, 0.3}};
    case CarryMotion::fast:
      return {{0.16, 0.7, 1.5}, {0.10, 0.3, 0.8}, {1.5 * kRad, 0.7, 1.5}, {15 * kRad, 0.2, 0.6}};
    case CarryMotion::shake:
      return {{0.01, 0.1, 0.5}, {0.01, 0.1, 0.5}, {1.5 * kRad, 5.0, 8.0}, {2 * kRad, 0.1, 0.5}};
    case CarryMotion::hover: break;
  }
  return {{0.01, 0.1, 0.5}, {0.01, 0.1, 0.5}, {0.2 * kRad, 0.3, 1.5}, {1 * kRad, 0.1, 0.3}};
}

double between(double least, double greatest, core::Random& random) {
  return least + (greatest - least) * core::uniform01(random);
}

}  // namespace

CarriedPath::CarriedPath(CarryMotion motion, std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "carried_path");
  const auto draw = [&random](const Swing& swing) {
    Waves waves;
    for (Wave& wave : waves)
      wave = {swing.rms * std::sqrt(2.0 / 3.0),
              kTurn * between(swing.least_hz, swing.greatest_hz, random),
              kTurn * core::uniform01(random)};
    return waves;
  };
  const Swings swing = swings(motion);
  waves_[kX] = draw(swing.place);
  waves_[kY] = draw(swing.place);
  waves_[kHeight] = draw(swing.height);
  waves_[kRoll] = draw(swing.tilt);
  waves_[kPitch] = draw(swing.tilt);
  waves_[kYaw] = draw(swing.yaw);
  height_m_ = between(0.9, 1.6, random);
  heading_rad_ = kTurn * core::uniform01(random);
  const double towards_rad = kTurn * core::uniform01(random);
  slide_m_ = 0.15 * Eigen::Vector2d(std::cos(towards_rad), std::sin(towards_rad));
}

double CarriedPath::sum(Axis axis, double t_s) const {
  double value = 0;
  for (const Wave& wave : waves_[axis])
    value += wave.amplitude * std::sin(wave.omega_rad_s * t_s + wave.phase_rad);
  return value;
}

Eigen::Isometry3d CarriedPath::T_target_camera(core::Time t) const {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double t_s = core::seconds(t);
  const double left = t_s < 1 ? 0.5 * (1 + std::cos(std::numbers::pi * t_s)) : 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << sum(kX, t_s) + left * slide_m_.x(), sum(kY, t_s) + left * slide_m_.y(),
      height_m_ + sum(kHeight, t_s);
  Eigen::Matrix3d R_target_upright;  // the picture's top along x, the view along -z
  R_target_upright << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  T.linear() = (AngleAxisd(heading_rad_ + sum(kYaw, t_s), Vector3d::UnitZ()) *
                AngleAxisd(sum(kPitch, t_s), Vector3d::UnitY()) *
                AngleAxisd(sum(kRoll, t_s), Vector3d::UnitX()))
                   .toRotationMatrix() *
               R_target_upright;
  return T;
}

}  // namespace nightjar::sim
