#include "sim/quadrotor.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <numeric>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

class QuadrotorTest : public testing::Test {
 protected:
  void fly(const Quadrotor::Thrusts& thrusts, double duration_s) {
    const double dt_s = scene_.model()->opt.timestep;
    for (long left = std::lround(duration_s / dt_s); left > 0; --left) {
      quadrotor_.apply(thrusts, dt_s, scene_);
      scene_.step();
    }
  }
  Eigen::Vector3d velocity() const {
    return scene_.velocity_at(quadrotor_.body(),
                              scene_.T_world_body(quadrotor_.body()).translation());
  }
  double weight_n() const { return quadrotor_.mass_kg() * 9.81; }

  Scene scene_{test::arena()};
  QuadrotorConfig config_;
  Quadrotor quadrotor_{config_, scene_};
};

TEST_F(QuadrotorTest, HoverThrustKeepsItInPlace) {
  fly(quadrotor_.allocate(weight_n(), Eigen::Vector3d::Zero()), 1.0);
  // Rotors start at hover speed, so nothing moves but for rounding.
  EXPECT_LT(velocity().norm(), 1e-6);
}

TEST_F(QuadrotorTest, AllocationGivesTheWrenchAskedFor) {
  const Eigen::Vector3d torque(0.08, -0.05, 0.02);
  const Quadrotor::Thrusts f = quadrotor_.allocate(weight_n(), torque);
  EXPECT_NEAR(std::accumulate(f.begin(), f.end(), 0.0), weight_n(), 1e-9);
  // Front left, front right, rear right, rear left; arms of 0.0884 m along x and y.
  EXPECT_NEAR(0.0884 * (f[0] - f[1] - f[2] + f[3]), torque.x(), 1e-9);
  EXPECT_NEAR(0.0884 * (-f[0] - f[1] + f[2] + f[3]), torque.y(), 1e-9);
  EXPECT_NEAR(0.016 * (-f[0] + f[1] - f[2] + f[3]), torque.z(), 1e-9);
}

TEST_F(QuadrotorTest, YawTorqueGivesWayBeforeRollAndPitch) {
  const Quadrotor::Thrusts f = quadrotor_.allocate(weight_n(), {0.1, 0, 5.0});
  EXPECT_NEAR(0.0884 * (f[0] - f[1] - f[2] + f[3]), 0.1, 1e-9);
  EXPECT_GT(0.016 * (-f[0] + f[1] - f[2] + f[3]), 0.1);  // what is left for it is used
}

TEST_F(QuadrotorTest, ThrustsStayWithinWhatARotorCanDo) {
  for (const double thrust : quadrotor_.allocate(1000, {3, 3, 3})) {
    EXPECT_GE(thrust, 0.0);
    EXPECT_LE(thrust, config_.max_rotor_thrust_n);
  }
}

TEST_F(QuadrotorTest, RotorSpeedFollowsWithItsTimeConstant) {
  // From hover speed towards full speed; after one time constant 1 - 1/e of the way.
  const double hover = std::sqrt(weight_n() / 4 / config_.max_rotor_thrust_n);
  Quadrotor::Thrusts full;
  full.fill(config_.max_rotor_thrust_n);
  fly(full, config_.motor_time_constant_s);
  const double speed = hover + (1 - hover) * (1 - std::exp(-1.0));
  const double thrust = scene_.data()->ctrl[scene_.id(mjOBJ_ACTUATOR, "rotor_1")];
  EXPECT_NEAR(thrust, config_.max_rotor_thrust_n * speed * speed, 1e-9);
}

TEST_F(QuadrotorTest, RisesToTheSpeedAtWhichDragBalancesTheExcessThrust) {
  const double excess_n = 0.35;  // drag_z 0.35 N s/m: 1 m/s
  fly(quadrotor_.allocate(weight_n() + excess_n, Eigen::Vector3d::Zero()), 15.0);
  // 15 s are over four time constants m / drag = 3.4 s: within 2 % of the end.
  EXPECT_NEAR(velocity().z(), 1.0, 0.02);
}

}  // namespace
}  // namespace nightjar::sim
