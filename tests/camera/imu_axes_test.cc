#include "camera/imu_axes.h"

#include <gtest/gtest.h>

namespace nightjar::camera {
namespace {

TEST(ImuAxesTest, turns_units_and_axes_into_the_cameras) {
  const RecordedImu sample = to_camera_axes(core::Time(7), {{1, -2, 3}, {180, 90, -180}}, 25);
  const double g = 9.80665, pi = 3.14159265358979;
  // 1e-9: rounding of doubles.
  EXPECT_TRUE(
      sample.specific_force_camera_m_s2.isApprox(Eigen::Vector3d(-g, -2 * g, -3 * g), 1e-9));
  EXPECT_TRUE(sample.omega_camera_rad_s.isApprox(Eigen::Vector3d(-pi, pi / 2, pi), 1e-9));
  EXPECT_EQ(sample.t, core::Time(7));
  EXPECT_EQ(sample.temperature_c, 25);
}

TEST(ImuAxesTest, gives_back_every_float_it_was_given) {
  float value = 1e-3f;
  for (int i = 0; i < 10'000; ++i, value *= 1.0013f) {
    const RawImu raw{{value, -value, value}, {-value, value, value}};
    const RawImu again = from_camera_axes(to_camera_axes(core::Time{}, raw, 0));
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(again.acceleration_g[k], raw.acceleration_g[k]);
      ASSERT_EQ(again.rate_deg_s[k], raw.rate_deg_s[k]);
    }
  }
}

}  // namespace
}  // namespace nightjar::camera
