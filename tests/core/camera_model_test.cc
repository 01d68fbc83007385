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
