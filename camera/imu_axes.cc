#include "camera/imu_axes.h"

#include <numbers>

namespace nightjar::camera {
namespace {

constexpr double kStandardGravity_m_s2 = 9.80665;  // ISO 80000-3
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kSign[3] = {-1, 1, -1};

}  // namespace

RecordedImu to_camera_axes(core::Time t, const RawImu& raw, float temperature_c) {
  RecordedImu sample;
  sample.t = t;
  sample.temperature_c = temperature_c;
  for (int i = 0; i < 3; ++i) {
    sample.specific_force_camera_m_s2[i] =
        kSign[i] * kStandardGravity_m_s2 * static_cast<double>(raw.acceleration_g[i]);
    sample.omega_camera_rad_s[i] = kSign[i] * kRadPerDeg * static_cast<double>(raw.rate_deg_s[i]);
  }
  return sample;
}

RawImu from_camera_axes(const core::ImuSample& sample) {
  RawImu raw;
  for (int i = 0; i < 3; ++i) {
    raw.acceleration_g[i] =
        static_cast<float>(kSign[i] * sample.specific_force_camera_m_s2[i] / kStandardGravity_m_s2);
    raw.rate_deg_s[i] = static_cast<float>(kSign[i] * sample.omega_camera_rad_s[i] / kRadPerDeg);
  }
  return raw;
}

bool fits_floats(const core::ImuSample& sample) {
  const RecordedImu again = to_camera_axes(sample.t, from_camera_axes(sample), 0);
  return again.omega_camera_rad_s == sample.omega_camera_rad_s &&
         again.specific_force_camera_m_s2 == sample.specific_force_camera_m_s2;
}

}  // namespace nightjar::camera
