#include "tracker/tag_fix.h"

#include <gtest/gtest.h>

#include "tag_picture.h"

namespace nightjar::tracker {
namespace {

constexpr double kTag_m = 0.24;

/// A camera looking straight down from `p_m`, picture's top towards world x.
Eigen::Isometry3d camera_at(const Eigen::Vector3d& p_m) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  T_world_camera.translation() = p_m;
  return T_world_camera;
}

Eigen::Isometry3d tag_at(const Eigen::Vector3d& p_m, double heading_rad, double tilt_rad = 0) {
  Eigen::Isometry3d T_world_tag = Eigen::Isometry3d::Identity();
  T_world_tag.linear() = (Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()))
                             .toRotationMatrix();
  T_world_tag.translation() = p_m;
  return T_world_tag;
}

std::optional<TagFix> fix_of(const Eigen::Isometry3d& T_world_camera,
                             const Eigen::Isometry3d& T_world_tag,
                             const MeasurementConfig& config = {}) {
  const TagPoseSolution pose{.T_camera_tag = T_world_camera.inverse() * T_world_tag};
  return tag_fix(core::Time(7), pose, T_world_camera, test_camera(), kTag_m, config);
}

TEST(TagFix, SaysWhereTheTagIsAndWhereItHeads) {
  const auto fix = fix_of(camera_at({1, 2, 3}), tag_at({1.2, 1.9, 0.2}, -2.5));
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->t, core::Time(7));
  EXPECT_LT((fix->z - Eigen::Vector4d(1.2, 1.9, 0.2, -2.5)).norm(), 1e-12);  // rounding
  EXPECT_NEAR(fix->tilt_rad, 0, 1e-7);                                       // arc cosine near 1
}

TEST(TagFix, IsRefusedForATagTiltedBeyondTheLimit) {
  MeasurementConfig config;
  config.max_tag_tilt_rad = 0.4;
  EXPECT_TRUE(fix_of(camera_at({0, 0, 2}), tag_at({0, 0, 0}, 1, 0.39), config));
  EXPECT_FALSE(fix_of(camera_at({0, 0, 2}), tag_at({0, 0, 0}, 1, 0.41), config));
}

TEST(TagFix, HasTheCovarianceThatCornerNoiseGivesSeenSquarely) {
  MeasurementConfig config;
  config.corner_noise_px = 0.3;
  config.attitude_noise_rad = config.position_noise_m = config.heading_noise_rad = 0;
  const auto T_world_camera = camera_at({0, 0, 1.5});
  const auto T_camera_tag = T_world_camera.inverse() * tag_at({0, 0, 0}, 0.3);
  core::Random random = core::random_stream(1, "corners");
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero(), model = Eigen::Matrix4d::Zero();
  constexpr int kRuns = 1000;
  for (int i = 0; i < kRuns; ++i) {
    core::TagDetection detection;
    for (std::size_t k = 0; k < 4; ++k)
      detection.corner_px[k] = *test_camera().project(T_camera_tag * tag_corners_m(kTag_m)[k]) +
                               0.3 * Eigen::Vector2d(core::normal(random), core::normal(random));
    const auto pose = tag_poses(detection, test_camera(), kTag_m).at(0);
    const auto fix = tag_fix({}, pose, T_world_camera, test_camera(), kTag_m, config);
    ASSERT_TRUE(fix);
    const Eigen::Vector4d error = fix->z - Eigen::Vector4d(0, 0, 0, 0.3);
    sum += error * error.transpose() / kRuns;
    model = fix->R;
  }
  // 1000 draws give a deviation to 2.2 %: 5 sigma across. The share of tilt in
  // range and heading is a rule of thumb, good to a quarter.
  const std::array<double, 4> tolerance{0.11, 0.11, 0.25, 0.25};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(std::sqrt(sum(i, i) / model(i, i)), 1, tolerance[i]) << "component " << i;
}

TEST(TagFix, SpreadsAttitudeNoiseAcrossTheLineOfSight) {
  MeasurementConfig config;
  config.corner_noise_px = 0.01;
  config.position_noise_m = 0;
  config.attitude_noise_rad = 0.02;
  const auto fix = fix_of(camera_at({0, 0, 2}), tag_at({0, 0, 0}, 0), config);
  ASSERT_TRUE(fix);
  // Range times noise; the corners' share is under a thousandth of it.
  EXPECT_NEAR(std::sqrt(fix->R(0, 0)), 0.04, 1e-4);
  EXPECT_NEAR(std::sqrt(fix->R(1, 1)), 0.04, 1e-4);
  EXPECT_LT(std::sqrt(fix->R(2, 2)), 0.001);
}

}  // namespace
}  // namespace nightjar::tracker
