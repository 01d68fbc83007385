#include "tracker/tag_pose.h"

#include <gtest/gtest.h>

#include <utility>

#include "tag_picture.h"
#include "tracker/tag_detector.h"

namespace nightjar::tracker {
namespace {

constexpr double kTag_m = 0.24;

core::TagDetection projected(const Eigen::Isometry3d& T_camera_tag,
                             const core::CameraModel& camera = test_camera()) {
  core::TagDetection detection;
  for (std::size_t i = 0; i < 4; ++i)
    detection.corner_px[i] = *camera.project(T_camera_tag * tag_corners_m(kTag_m)[i]);
  return detection;
}

core::TagDetection noisy(core::TagDetection detection, double sigma_px, core::Random& random) {
  for (auto& corner : detection.corner_px)
    corner += sigma_px * Eigen::Vector2d(core::normal(random), core::normal(random));
  return detection;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

Eigen::Isometry3d nearest(const std::vector<TagPoseSolution>& solutions,
                          const Eigen::Isometry3d& T) {
  Eigen::Isometry3d best = solutions.at(0).T_camera_tag;
  for (const auto& solution : solutions)
    if (angle_between(solution.T_camera_tag, T) < angle_between(best, T))
      best = solution.T_camera_tag;
  return best;
}

TEST(TagPose, GivesThePoseBackThatExactCornersCameFrom) {
  core::Random random = core::random_stream(1, "poses");
  const auto within = [&](double most) { return most * (2 * core::uniform01(random) - 1); };
  for (int i = 0; i < 200; ++i) {
    const auto T = pose_above(1.3 + within(1), within(0.4), within(0.3), within(3.14), within(0.5),
                              within(0.5));
    const auto solutions = tag_poses(projected(T), test_camera(), kTag_m);
    ASSERT_FALSE(solutions.empty());
    // Rounding only: corners of 1e2 px in double, and a minimum that is as
    // flat as the fourth power when the tag is seen squarely.
    EXPECT_LT(solutions[0].error_px, 1e-6);
    EXPECT_LT((solutions[0].T_camera_tag.translation() - T.translation()).norm(), 1e-5);
    EXPECT_LT(angle_between(solutions[0].T_camera_tag, T), 1e-3);
  }
}

TEST(TagPose, distorted_corners_give_the_poses_that_undistorted_ones_give) {
  core::CameraModel camera = test_camera();
  camera.lens = {-0.25, 0.08, 0.002, -0.001, 0.01};
  core::Random random = core::random_stream(6, "poses");
  const auto within = [&](double most) { return most * (2 * core::uniform01(random) - 1); };
  for (int i = 0; i < 100; ++i) {
    const auto T = pose_above(1.0 + within(0.3), within(0.35), within(0.25), within(3.14),
                              within(0.5), within(0.5));
    const auto straight = tag_poses(projected(T), test_camera(), kTag_m);
    const auto bent = tag_poses(projected(T, camera), camera, kTag_m);
    ASSERT_EQ(bent.size(), straight.size());
    for (std::size_t k = 0; k < bent.size(); ++k) {
      // The corners agree to 1e-9 px; the tilt, where the minimum is as flat as the fourth
      // power, to as little as the test above finds.
      EXPECT_NEAR(bent[k].error_px, straight[k].error_px, 1e-6);
      EXPECT_LT(
          (bent[k].T_camera_tag.translation() - straight[k].T_camera_tag.translation()).norm(),
          1e-5);
      EXPECT_LT(angle_between(bent[k].T_camera_tag, straight[k].T_camera_tag), 1e-3);
    }
  }
}

TEST(TagPose, corners_where_the_lens_shows_nothing_have_no_pose) {
  core::CameraModel camera = test_camera();
  camera.lens.k1 = -0.9;
  core::TagDetection tag = projected(pose_above(1.0, 0, 0, 0));
  ASSERT_FALSE(tag_poses(tag, camera, kTag_m).empty());
  for (auto& corner : tag.corner_px) corner.x() += 130;
  EXPECT_TRUE(tag_poses(tag, camera, kTag_m).empty());
}

TEST(TagPose, IsIdentityTurnForATagWhoseTopPointsAlongThePicturesTop) {
  // Camera looking down, picture's top towards world x: x_c = -y, y_c = -x, z_c = -z.
  core::TagDetection upright;
  upright.corner_px = {{{150, 150}, {190, 150}, {190, 110}, {150, 110}}};
  const auto solutions = tag_poses(upright, test_camera(), kTag_m);
  ASSERT_FALSE(solutions.empty());
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  const Eigen::Matrix3d R_world_tag = R_world_camera * solutions[0].T_camera_tag.linear();
  EXPECT_GT(R_world_tag(2, 2), 0.99);  // square corners aside of the middle: a little tilt
  EXPECT_NEAR(std::atan2(R_world_tag(1, 0), R_world_tag(0, 0)), 0, 0.02);
  EXPECT_NEAR(solutions[0].T_camera_tag.translation().z(), 297 * kTag_m / 40, 0.01);
}

TEST(TagPose, IsWithinMillimetresOnRenderedPictures) {
  TagDetector detector{DetectorConfig{}};
  core::Random random = core::random_stream(2, "poses");
  const auto within = [&](double most) { return most * (2 * core::uniform01(random) - 1); };
  for (int i = 0; i < 25; ++i) {
    const auto T = pose_above(1.1 + within(0.5), within(0.1), within(0.1), within(3.14),
                              within(0.1), within(0.1));
    const auto found = detector.detect(tag_picture(test_camera(), T));
    ASSERT_EQ(found.size(), 1u);
    const auto solutions = tag_poses(found[0], test_camera(), kTag_m);
    ASSERT_FALSE(solutions.empty());
    const Eigen::Vector3d error = nearest(solutions, T).translation() - T.translation();
    // Corners are good to 0.08 px rms (3 sigma 0.24): across z sigma / (2 f) and
    // along z^2 sigma / (sqrt(2) f a), that is 0.6 mm and 6 mm at 1.6 m.
    EXPECT_LT(error.head<2>().norm(), 2e-3);
    EXPECT_LT(std::abs(error.z()), 6e-3);
  }
}

TEST(TagPose, OffersTheOtherTiltWithTheTruthAmongTheTwo) {
  core::Random random = core::random_stream(3, "noise");
  constexpr int kRuns = 200;
  const auto T = pose_above(2, 0, 0, 0.5, 0.2, 0);
  int two = 0, better_was_wrong = 0;
  double first2 = 0, nearest2 = 0;
  for (int i = 0; i < kRuns; ++i) {
    const auto solutions = tag_poses(noisy(projected(T), 0.4, random), test_camera(), kTag_m);
    ASSERT_FALSE(solutions.empty());
    const double first = angle_between(solutions[0].T_camera_tag, T);
    const double best = angle_between(nearest(solutions, T), T);
    first2 += first * first / kRuns;
    nearest2 += best * best / kRuns;
    two += solutions.size() == 2;
    better_was_wrong += best < first;
    if (solutions.size() == 2) {
      EXPECT_LE(solutions[0].error_px, solutions[1].error_px);
    }
  }
  // With this seed 112 had two solutions, in 34 or so the worse one was right.
  EXPECT_GT(two, 80);
  EXPECT_GT(better_was_wrong, 15);
  EXPECT_LT(std::sqrt(nearest2), 0.75 * std::sqrt(first2));
}

TEST(TagPose, GivesOneSolutionForATagSeenSquarely) {
  const auto solutions = tag_poses(projected(pose_above(1, 0, 0, 0)), test_camera(), kTag_m);
  EXPECT_EQ(solutions.size(), 1u);
}

TEST(TagPose, KeepsThePositionSteadyWhereTheTiltIsAmbiguous) {
  core::Random random = core::random_stream(4, "noise");
  double across2 = 0, tilt2 = 0;
  constexpr int kRuns = 300;
  const auto T = pose_above(1.5, 0, 0, 0);
  for (int i = 0; i < kRuns; ++i) {
    const auto solutions = tag_poses(noisy(projected(T), 0.3, random), test_camera(), kTag_m);
    ASSERT_FALSE(solutions.empty());
    const auto& found = solutions[0].T_camera_tag;
    across2 += (found.translation() - T.translation()).head<2>().squaredNorm() / 2;
    tilt2 += std::pow(std::acos(-found.linear()(2, 2)), 2);
  }
  // z sigma / (sqrt(2) f) = 1.07 mm (tag_fix.cc says why); 600 coordinates give
  // the deviation to 2.9 %: 5 sigma.
  EXPECT_NEAR(std::sqrt(across2 / kRuns), 1.07e-3, 0.16e-3);
  EXPECT_GT(std::sqrt(tilt2 / kRuns), 0.05);  // several degrees: never to be used alone
}

TEST(TagPose, GivesNothingForCornersNoSquareCanHave) {
  core::TagDetection detection = projected(pose_above(1, 0.1, 0, 0.4));
  std::swap(detection.corner_px[0], detection.corner_px[1]);  // crossed
  EXPECT_TRUE(tag_poses(detection, test_camera(), kTag_m).empty());
  detection = projected(pose_above(1, 0.1, 0, 0.4));
  std::reverse(detection.corner_px.begin(), detection.corner_px.end());  // mirrored
  EXPECT_TRUE(tag_poses(detection, test_camera(), kTag_m).empty());
  detection.corner_px.fill({10, 10});
  EXPECT_TRUE(tag_poses(detection, test_camera(), kTag_m).empty());
}

}  // namespace
}  // namespace nightjar::tracker
