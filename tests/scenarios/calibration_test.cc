#include "scenarios/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "core/random.h"
#include "tests/support/board_pictures.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

constexpr core::Resolution kSize{346, 260};

/// Views of a 9 x 6 board with noise on every corner; `seed` of that noise.
std::vector<BoardView> noisy_views(int count, double sigma_px, int seed,
                                   const core::CameraModel& camera = test::distorting_camera()) {
  core::Random random = core::random_stream(static_cast<std::uint64_t>(seed), "corners");
  std::vector<BoardView> views;
  for (int k = 0; k < count; ++k) {
    const Eigen::Isometry3d T = test::board_pose(k, {0.12, 0.075}, 0.3, test::kCheckerboardFace);
    BoardView& view = views.emplace_back();
    view.picture = std::to_string(k);
    for (int i = 0; i < 54; ++i) {
      const Eigen::Vector2d corner_m(0.03 * (i % 9), 0.03 * (i / 9));
      view.corner_m.push_back(corner_m);
      view.corner_px.push_back(*camera.project(T * Eigen::Vector3d(corner_m.x(), corner_m.y(), 0)) +
                               sigma_px *
                                   Eigen::Vector2d(core::normal(random), core::normal(random)));
    }
  }
  return views;
}

std::vector<double> numbers(const core::CameraModel& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.lens.k1, c.lens.k2, c.lens.p1, c.lens.p2};
}

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(CalibrationTest, our_camera_projects_as_opencv_does) {
  core::CameraModel camera = test::distorting_camera();
  camera.lens.k3 = 0.03;
  const std::vector<cv::Point3d> points = {{0.3, -0.2, 1}, {-0.5, 0.4, 1}, {0.1, 0.05, 0.9}};
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Mat distortion = (cv::Mat_<double>(5, 1) << -0.21, 0.07, 0.0012, -0.0008, 0.03);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, distortion, pixels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto ours = camera.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(ours);
    EXPECT_NEAR(ours->x(), pixels[i].x, 1e-9);  // double rounding of some hundred px
    EXPECT_NEAR(ours->y(), pixels[i].y, 1e-9);
  }
}

TEST(CalibrationTest, exact_corners_give_the_camera_back) {
  const Calibration result = calibrate(noisy_views(12, 0, 1), kSize, {});
  // Corners go to OpenCV as floats: 1.5e-5 px.
  EXPECT_LT(result.rms_px, 1e-4);
  const auto truth = numbers(test::distorting_camera()), found = numbers(result.camera);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(found[i], truth[i], i < 4 ? 1e-2 : 1e-3) << i;
  EXPECT_EQ(result.camera.lens.k3, 0);
  EXPECT_EQ(result.sigma.lens.k3, 0);
  EXPECT_EQ(result.camera.size, kSize);
}

TEST(CalibrationTest, is_as_wrong_as_its_standard_deviations_say) {
  const auto truth = numbers(test::distorting_camera());
  constexpr int kRuns = 15;  // seeds 1 to 15
  std::vector<double> sum(truth.size());
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Calibration result = calibrate(noisy_views(15, 0.1, seed), kSize, {});
    // 15 views of 54 corners, 2 numbers each, less 8 + 15 * 6 that were fitted: 0.141 px times
    // sqrt(1522 / 1620), known to 2 %.
    EXPECT_NEAR(result.rms_px, 0.137, 0.137 * 5 * 0.02);
    const auto found = numbers(result.camera), sigma = numbers(result.sigma);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double z = (found[i] - truth[i]) / sigma[i];
      EXPECT_LT(std::abs(z), 4.5) << i << " seed " << seed;  // 1 in 150000, 120 tried
      sum[i] += z * z;
    }
  }
  // Chi-square with 15 degrees of freedom: 99.99 % lie between 2.7 and 44.
  for (const double chi2 : sum) {
    EXPECT_GT(chi2, 2.7);
    EXPECT_LT(chi2, 44);
  }
}

TEST(CalibrationTest, finds_k3_when_asked) {
  core::CameraModel wide = test::distorting_camera();
  wide.lens.k3 = -0.06;
  const auto views = noisy_views(25, 0.02, 3, wide);
  const Calibration with = calibrate(views, kSize, {.k3 = true});
  EXPECT_NEAR(with.camera.lens.k3, -0.06, 4 * with.sigma.lens.k3);
  EXPECT_GT(with.sigma.lens.k3, 0);
}

TEST(CalibrationTest, residuals_are_seen_minus_projected) {
  const Calibration result = calibrate(noisy_views(10, 0.1, 4), kSize, {});
  const CalibratedView& view = result.views.at(3);
  const Eigen::Vector3d corner_m(view.corner_m[7].x(), view.corner_m[7].y(), 0);
  const Eigen::Vector2d projected = *result.camera.project(view.T_camera_board * corner_m);
  EXPECT_EQ(view.residual_px[7], view.corner_px[7] - projected);
  EXPECT_EQ(view.picture, "3");
  double sum = 0;
  for (const auto& residual : view.residual_px) sum += residual.squaredNorm();
  EXPECT_DOUBLE_EQ(view.rms_px, std::sqrt(sum / 54));
}

TEST(CalibrationTest, leaves_out_a_view_that_fits_far_worse) {
  auto views = noisy_views(15, 0.1, 5);
  for (std::size_t i = 0; i < 27; ++i) views[6].corner_px[i].x() += 8;  // half a board is off
  const Calibration result = calibrate(views, kSize, {});
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_EQ(result.left_out[0].picture, "6");
  EXPECT_EQ(result.views.size(), 14u);
  EXPECT_LT(result.rms_px, 0.15);  // the noise, see above, plus 5 times 2 %
}

TEST(CalibrationTest, covered_counts_cells_with_a_corner) {
  Calibration result;
  result.camera.size = kSize;
  result.views.resize(1);
  result.views[0].corner_px = {{-0.4, -0.4}, {3, 3}, {345.4, 259.4}};  // two of 48 cells
  EXPECT_DOUBLE_EQ(result.covered(), 2.0 / 48);
}

TEST(CalibrationTest, refuses_too_few_views) {
  EXPECT_THAT(error_of([] { calibrate(noisy_views(7, 0.1, 1), kSize, {}); }),
              HasSubstr("7 views of the board that differ, expected at least 8"));
}

TEST(CalibrationTest, refuses_views_that_make_no_camera) {
  auto scattered = noisy_views(10, 0, 1);
  core::Random random = core::random_stream(9, "scattered");
  for (BoardView& view : scattered)
    for (Eigen::Vector2d& corner : view.corner_px)
      corner = {345 * core::uniform01(random), 259 * core::uniform01(random)};
  auto nowhere = noisy_views(10, 0, 1);
  for (BoardView& view : nowhere)
    for (Eigen::Vector2d& corner : view.corner_px) corner = {100, 100};
  for (const auto& views : {scattered, nowhere})
    EXPECT_THAT(error_of([&] { calibrate(views, kSize, {}); }),
                HasSubstr("these views do not make a camera"));
}

}  // namespace
}  // namespace nightjar::scenarios
