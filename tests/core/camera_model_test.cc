#include "core/camera_model.h"

#include <gtest/gtest.h>

#include <numbers>

namespace nightjar::core {
namespace {

constexpr Resolution kSensor{346, 260};
const CameraModel kCamera = CameraModel::from_fovy(kSensor, 47.3 * std::numbers::pi / 180.0);

TEST(CameraModel, FieldOfViewGivesTheStatedFocalLength) {
  // 130 / tan(23.65 deg) = 296.85.
  EXPECT_NEAR(kCamera.fx_px, 296.85, 0.005);
  EXPECT_EQ(kCamera.fx_px, kCamera.fy_px);
}

TEST(CameraModel, OpticalAxisMeetsTheMiddleBetweenTheFourCentralPixels) {
  const auto p = kCamera.project({0, 0, 2});
  ASSERT_TRUE(p);
  EXPECT_DOUBLE_EQ(p->x(), 172.5);
  EXPECT_DOUBLE_EQ(p->y(), 129.5);
}

TEST(CameraModel, RayAndProjectionAreInverse) {
  const Eigen::Vector2d pixel(17.25, 201.5);
  const auto back = kCamera.project(3.7 * kCamera.ray(pixel));
  ASSERT_TRUE(back);
  EXPECT_LT((*back - pixel).norm(), 1e-9);  // double rounding
}

TEST(CameraModel, ray_and_projection_are_inverse_through_a_lens_too) {
  CameraModel camera = kCamera;
  camera.lens = {-0.2, 0.05, 0.001, -0.002, 0};
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), {345, 259}, {17.25, 201.5}}) {
    const auto back = camera.project(3.7 * camera.ray(pixel));
    ASSERT_TRUE(back);
    EXPECT_LT((*back - pixel).norm(), 1e-9);  // Lens::undistort's 1e-12 times 300 px
    EXPECT_LT((*camera.pinhole().project(camera.ray(pixel)) - camera.undistorted(pixel)).norm(),
              1e-9);
    EXPECT_GT((camera.undistorted(pixel) - pixel).norm(), 1.0);  // the lens does something
  }
}

TEST(CameraModel, without_a_lens_a_pixel_is_undistorted_to_the_bit) {
  EXPECT_EQ(kCamera.undistorted({17.3, 201.7}), Eigen::Vector2d(17.3, 201.7));
}

TEST(CameraModel, a_pixel_beyond_the_lens_has_no_ray_and_a_point_there_no_pixel) {
  CameraModel camera = kCamera;
  camera.lens.k1 = -0.7;  // turns at r = 0.69, seen at 0.46: 137 px from the middle
  EXPECT_FALSE(camera.ray({0, 0}).allFinite());
  EXPECT_TRUE(camera.ray({40, 129}).allFinite());
  EXPECT_FALSE(camera.project({0.8, 0, 1}));
  EXPECT_TRUE(camera.project({0.6, 0, 1}));
}

TEST(CameraModel, PointsBehindHaveNoPixel) {
  EXPECT_FALSE(kCamera.project({0.1, 0.1, 0.0}));
  EXPECT_FALSE(kCamera.project({0.1, 0.1, -1.0}));
}

TEST(CameraModel, SensorEndsHalfAPixelOutsideItsOutermostCentres) {
  EXPECT_TRUE(kCamera.contains({-0.5, -0.5}));
  EXPECT_FALSE(kCamera.contains({-0.51, 0}));
  EXPECT_FALSE(kCamera.contains({345.5, 0}));
  EXPECT_FALSE(kCamera.contains({4, 100}, 5));
}

}  // namespace
}  // namespace nightjar::core
