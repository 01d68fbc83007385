#include "sim/carried_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/camera_model.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

const core::CameraModel kCamera =
    core::CameraModel::from_fovy({346, 260}, 47.3 * std::numbers::pi / 180);

Eigen::Vector2d target_px(const CarriedPath& path, core::Time t) {
  return *kCamera.project(path.T_target_camera(t).inverse().translation());
}

/// Root mean square over seeds and seconds 1 to 6 of how fast the point of the target that is
/// in the middle moves, as if seen from 1.2 m.
double speed_px_s(CarryMotion motion) {
  double square = 0;
  int count = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const CarriedPath path(motion, seed);
    for (core::Time t = 1s; t < 6s; t += 10ms, ++count) {
      const Eigen::Isometry3d T_target_camera = path.T_target_camera(t);
      const Eigen::Vector3d from = T_target_camera.translation();
      const Eigen::Vector3d ahead = T_target_camera.linear().col(2);
      const Eigen::Vector3d point = from - from.z() / ahead.z() * ahead;
      const auto pixel = kCamera.project(path.T_target_camera(t + 1ms).inverse() * point);
      const Eigen::Vector2d middle(kCamera.cx_px, kCamera.cy_px);
      square += std::pow((*pixel - middle).norm() / 1e-3 * from.z() / 1.2, 2);
    }
  }
  return std::sqrt(square / count);
}

TEST(CarriedPath, moves_the_picture_as_fast_as_it_says) {
  // "About": within a factor of 1.4. Frequencies are drawn anew for each seed and axis.
  EXPECT_GT(speed_px_s(CarryMotion::slow), 60 / 1.4);
  EXPECT_LT(speed_px_s(CarryMotion::slow), 60 * 1.4);
  EXPECT_GT(speed_px_s(CarryMotion::fast), 350 / 1.4);
  EXPECT_LT(speed_px_s(CarryMotion::fast), 350 * 1.4);
}

TEST(CarriedPath, hovers_within_a_few_pixels_after_a_slide) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const CarriedPath path(CarryMotion::hover, seed);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (core::Time t = 1s; t < 11s; t += 10ms) mean += target_px(path, t) / 1000;
    double square = 0;
    for (core::Time t = 1s; t < 11s; t += 10ms)
      square += (target_px(path, t) - mean).squaredNorm() / 1000;
    EXPECT_LT(std::sqrt(square), 8) << seed;
    EXPECT_GT(std::sqrt(square), 1) << seed;
    // 0.15 m from 0.9 to 1.6 m are 50 to 28 px, and what drifts meanwhile.
    const double slide_px = (target_px(path, 1s) - target_px(path, 0s)).norm();
    EXPECT_GT(slide_px, 15) << seed;
    EXPECT_LT(slide_px, 65) << seed;
  }
}

TEST(CarriedPath, shakes_by_a_degree_and_a_half_five_to_eight_times_a_second) {
  double square_deg2 = 0, square_rate = 0;
  int count = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const CarriedPath path(CarryMotion::shake, seed);
    const auto lean_deg = [&path](core::Time t) {  // of the view from straight down
      const Eigen::Vector3d ahead = path.T_target_camera(t).linear().col(2);
      return Eigen::Vector2d(180 / std::numbers::pi * ahead.head<2>());
    };
    for (core::Time t = 1s; t < 5s; t += 1ms, ++count) {
      square_deg2 += lean_deg(t).squaredNorm();
      square_rate += (lean_deg(t + 1ms) - lean_deg(t)).squaredNorm() / 1e-6;
    }
  }
  // Both axes have 1.5 degrees; a mean of sines over 4 s is within a tenth.
  const double deg = std::sqrt(square_deg2 / count);
  EXPECT_NEAR(deg, 1.5 * std::sqrt(2), 0.2);
  const double tilts_hz = std::sqrt(square_rate / count) / deg / (2 * std::numbers::pi);
  EXPECT_GT(tilts_hz, 5);
  EXPECT_LT(tilts_hz, 8);
}

TEST(CarriedPath, is_smooth) {
  for (const auto& [name, motion] : kCarryMotions)
    for (const std::uint64_t seed : {1, 2, 3}) {
      const CarriedPath path(motion, seed);
      for (core::Time t = 0s; t < 3s; t += 100us) {
        // Three waves of sqrt(2/3) * 1.5 degrees at 8 Hz, on both axes: 2020 px/s at most, and
        // as much at the most from moving fast.
        ASSERT_LT((target_px(path, t + 100us) - target_px(path, t)).norm(), 0.25) << name;
        const Eigen::Vector3d before = path.T_target_camera(t).translation();
        const Eigen::Vector3d at = path.T_target_camera(t + 1ms).translation();
        const Eigen::Vector3d after = path.T_target_camera(t + 2ms).translation();
        // Three waves of sqrt(2/3) * 0.16 m at 1.5 Hz are 35 m/s^2 on each of two axes.
        ASSERT_LT((before - 2 * at + after).norm() / 1e-6, 55) << name;
      }
    }
}

TEST(CarriedPath, looks_down_on_the_target_from_near) {
  for (const auto& [name, motion] : kCarryMotions)
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      const CarriedPath path(motion, seed);
      for (core::Time t = 0s; t < 5s; t += 50ms) {
        const Eigen::Isometry3d T = path.T_target_camera(t);
        EXPECT_TRUE(T.linear().isUnitary(1e-12));
        EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
        EXPECT_LT(T.linear()(2, 2), -0.98) << name;  // within 11 degrees of straight down
        // 0.9 to 1.6 m, and three waves of at most sqrt(2/3) * 0.10 m.
        EXPECT_GT(T.translation().z(), 0.65) << name;
        EXPECT_LT(T.translation().z(), 1.85) << name;
      }
    }
}

TEST(CarriedPath, is_the_same_for_the_same_seed_only) {
  const CarriedPath a(CarryMotion::fast, 1), b(CarryMotion::fast, 1), c(CarryMotion::fast, 2);
  EXPECT_EQ(a.T_target_camera(2s).matrix(), b.T_target_camera(2s).matrix());
  EXPECT_NE(a.T_target_camera(2s).matrix(), c.T_target_camera(2s).matrix());
}

}  // namespace
}  // namespace nightjar::sim
