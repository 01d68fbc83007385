#include "sim/autopilot.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

TEST(GaussMarkov, IsStationaryWithItsSigmaAndCorrelation) {
  GaussMarkov error(Eigen::Vector3d::Constant(2.0), 0.1, core::random_stream(5, "test"));
  constexpr int kSamples = 20000;
  double squares = 0, products = 0;
  Eigen::Vector3d before = error.value();
  for (int i = 0; i < kSamples; ++i) {
    error.advance(0.05);
    squares += error.value().squaredNorm();
    products += error.value().dot(before);
    before = error.value();
  }
  // exp(-0.5) between neighbours, so about n (1 - r) / (1 + r) = 0.245 n independent
  // samples on each of 3 axes; 5 sigma of a variance estimate is 5 sqrt(2 / n).
  const double tolerance = 5 * std::sqrt(2 / (3 * 0.245 * kSamples));
  EXPECT_NEAR(squares / (3.0 * kSamples) / 4.0, 1.0, tolerance);
  EXPECT_NEAR(products / squares, std::exp(-0.5), tolerance);
}

TEST(GaussMarkov, StepSizeDoesNotChangeTheStatistics) {
  GaussMarkov fine(Eigen::Vector3d::Ones(), 1.0, core::random_stream(1, "a"));
  GaussMarkov coarse(Eigen::Vector3d::Ones(), 1.0, core::random_stream(2, "b"));
  double fine_squares = 0, coarse_squares = 0;
  constexpr int kSamples = 4000;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < 20; ++j) fine.advance(0.25);
    coarse.advance(5.0);
    fine_squares += fine.value().squaredNorm();
    coarse_squares += coarse.value().squaredNorm();
  }
  // Samples 5 correlation times apart are as good as independent.
  EXPECT_NEAR(fine_squares / coarse_squares, 1.0, 5 * std::sqrt(2 * 2.0 / (3.0 * kSamples)));
}

class AutopilotTest : public testing::Test {
 protected:
  void fly(Autopilot& autopilot, const core::AttitudeSetpoint& setpoint, double duration_s) {
    const double dt_s = scene_.model()->opt.timestep;
    for (long i = 1; i <= std::lround(duration_s / dt_s); ++i) {
      quadrotor_.apply(autopilot.control(setpoint), dt_s, scene_);
      scene_.step();
      autopilot.observe(scene_, core::from_seconds(static_cast<double>(i) * dt_s), dt_s);
    }
  }
  Eigen::Quaterniond true_attitude() const {
    return Eigen::Quaterniond(scene_.T_world_body(quadrotor_.body()).linear());
  }
  static AutopilotConfig exact() {
    AutopilotConfig config;
    config.position_sigma_m = config.velocity_sigma_m_s = config.tilt_sigma_deg =
        config.heading_sigma_deg = config.rate_sigma_rad_s = 0;
    return config;
  }

  Scene scene_{test::arena()};
  Quadrotor quadrotor_{QuadrotorConfig{}, scene_};
};

TEST_F(AutopilotTest, TurnsToTheAttitudeItIsAskedFor) {
  Autopilot autopilot(exact(), quadrotor_, 1);
  autopilot.observe(scene_, core::Time(0), 0);
  core::AttitudeSetpoint setpoint;
  setpoint.thrust_m_s2 = 9.81;
  setpoint.q_world_body = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  fly(autopilot, setpoint, 2.0);
  // Yaw saturates for most of the first second; then gains of 10 and 20 per second leave
  // exp(-7) of what remained.
  EXPECT_LT(true_attitude().angularDistance(setpoint.q_world_body), 2e-3);
}

TEST_F(AutopilotTest, EstimateIsTruthPlusItsStatedErrors) {
  const AutopilotConfig config;
  double squares_m2 = 0, squares_rad2 = 0;
  constexpr int kSeeds = 400;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Autopilot autopilot(config, quadrotor_, static_cast<std::uint64_t>(seed));
    autopilot.observe(scene_, core::Time(0), 0);
    squares_m2 +=
        (autopilot.state().p_world_body_m - scene_.T_world_body(quadrotor_.body()).translation())
            .squaredNorm();
    squares_rad2 += std::pow(autopilot.state().q_world_body.angularDistance(true_attitude()), 2);
  }
  const double degree = std::acos(-1.0) / 180;
  const double expected_rad2 = (2 * 0.3 * 0.3 + 1.0) * degree * degree;
  // Heading dominates the rotation: as good as one chi-square degree of freedom.
  EXPECT_NEAR(squares_m2 / (3 * kSeeds) / (0.03 * 0.03), 1.0, 5 * std::sqrt(2.0 / (3 * kSeeds)));
  EXPECT_NEAR(squares_rad2 / kSeeds / expected_rad2, 1.0, 5 * std::sqrt(2.0 / kSeeds));
}

TEST_F(AutopilotTest, MotorsOffMeansNoThrust) {
  Autopilot autopilot(exact(), quadrotor_, 1);
  core::AttitudeSetpoint setpoint;
  setpoint.thrust_m_s2 = 9.81;
  setpoint.motors_on = false;
  for (const double thrust : autopilot.control(setpoint)) EXPECT_EQ(thrust, 0.0);
}

}  // namespace
}  // namespace nightjar::sim
