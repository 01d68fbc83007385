#include "scenarios/parameter_unit.h"

#include <gtest/gtest.h>

namespace nightjar::scenarios {
namespace {

TEST(ParameterUnit, the_longest_ending_tells_the_unit) {
  EXPECT_EQ(unit_of("size_m"), "m");
  EXPECT_EQ(unit_of("speed_m_s"), "m/s");
  EXPECT_EQ(unit_of("max_acceleration_m_s2"), "m/s^2");
  EXPECT_EQ(unit_of("timeout_s"), "s");
  EXPECT_EQ(unit_of("interval_ms"), "ms");
  EXPECT_EQ(unit_of("drag_z_n_s_m"), "N s/m");
  EXPECT_EQ(unit_of("max_line_fit_mse_px2"), "px^2");
  EXPECT_EQ(unit_of("gyro_noise_deg_s_sqrt_hz"), "deg/s/sqrt(Hz)");
  EXPECT_EQ(unit_of("hot_pixel_rate_sigma_ln"), "ln");
}

TEST(ParameterUnit, a_name_without_an_ending_has_none) {
  for (const char* name : {"seed", "m", "lux", "leak_jitter", "max_hamming", ""})
    EXPECT_EQ(unit_of(name), "") << name;
}

}  // namespace
}  // namespace nightjar::scenarios
