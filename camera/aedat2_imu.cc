#include "camera/aedat2_imu.h"

#include <charconv>

#include "camera/imu_axes.h"

namespace nightjar::camera {
namespace {

constexpr int kFullScale = 32768;

// MPU-6150 data sheet, temperature sensor; as in jAER's IMUSample.java.
constexpr double kCountsPerDegree = 340.0, kDegreesAtZero_c = 35.0;

/// The number at the end of a setting's value: of `... key="IMU.AccelScale"
/// value="ImuAccelScaleG8"/>` the 8. 0 where there is none or it is another setting's.
int number_of(std::string_view line, std::string_view key, std::string_view before) {
  if (line.find(key) == std::string_view::npos) return 0;
  const std::size_t at = line.find(before);
  if (at == std::string_view::npos) return 0;
  int number = 0;
  std::from_chars(line.data() + at + before.size(), line.data() + line.size(), number);
  return number;
}

}  // namespace

void ImuScale::take(std::string_view line) {
  const int full_g = number_of(line, "IMU.AccelScale", "ImuAccelScaleG");
  if (full_g >= 2 && full_g <= 16) g = static_cast<double>(full_g) / kFullScale;
  const int full_deg_s = number_of(line, "IMU.GyroScale", "GyroFullScaleDegPerSec");
  if (full_deg_s >= 250 && full_deg_s <= 2000) deg_s = static_cast<double>(full_deg_s) / kFullScale;
}

std::optional<RecordedImu> Aedat2Imu::add(unsigned code, std::int16_t count, core::Time t) {
  if (code != have_) {
    finish();
    if (code != 0) {
      ++lost_;
      return std::nullopt;
    }
  }
  if (code == 0) t_ = t;
  counts_[have_++] = count;
  if (have_ < counts_.size()) return std::nullopt;
  have_ = 0;
  return sample();
}

void Aedat2Imu::finish() {
  lost_ += have_;
  have_ = 0;
}

RecordedImu Aedat2Imu::sample() const {
  RawImu raw;
  for (std::size_t i = 0; i < 3; ++i) {
    raw.acceleration_g[i] = static_cast<float>(scale_.g * counts_[i]);
    raw.rate_deg_s[i] = static_cast<float>(scale_.deg_s * counts_[4 + i]);
  }
  const double temperature_c = counts_[3] / kCountsPerDegree + kDegreesAtZero_c;
  return to_camera_axes(t_, raw, static_cast<float>(temperature_c));
}

}  // namespace nightjar::camera
