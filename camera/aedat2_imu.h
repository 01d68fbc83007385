#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "camera/recording.h"

namespace nightjar::camera {

/// What a count of the inertial chip (InvenSense MPU-6150) stands for; the file has it among
/// the settings in its header, if at all. By default jAER's own: 8 g and 1000 deg/s.
struct ImuScale {
  double g = 8.0 / 32768;  ///< Full scale over 2^15.
  double deg_s = 1000.0 / 32768;

  /// Takes a line of the header: one of jAER's settings "IMU.AccelScale" or "IMU.GyroScale",
  /// or any other.
  void take(std::string_view line);
};

/// Puts AEDAT 2.0's seven records a sample together: acceleration x, y, z, temperature, rate
/// x, y, z, in that order and of one time.
class Aedat2Imu {
 public:
  explicit Aedat2Imu(const ImuScale& scale) : scale_(scale) {}

  /// `code` 0 to 7 says which of the seven it is. The sample that it completes.
  std::optional<RecordedImu> add(unsigned code, std::int16_t count, core::Time t);

  /// To be called at the end of the file, which cuts off the sample at hand.
  void finish();

  /// Records that belong to no whole sample, so far.
  std::uint64_t records_lost() const { return lost_; }

 private:
  RecordedImu sample() const;

  ImuScale scale_;
  std::array<std::int16_t, 7> counts_{};
  unsigned have_ = 0;
  core::Time t_{};  ///< Of the first of the seven.
  std::uint64_t lost_ = 0;
};

}  // namespace nightjar::camera
