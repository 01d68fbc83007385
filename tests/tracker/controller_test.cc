#include "tracker/controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "plant.h"
#include "tracker/ekf.h"

namespace nightjar::tracker {
namespace {

using core::Time;

constexpr Time kPicture = std::chrono::milliseconds(10);
constexpr double kRad_deg = std::numbers::pi / 180;

ControllerConfig steady() {
  ControllerConfig config;
  config.dither_tilt_deg = 0;
  return config;
}

FlightGoal goal_of(const TargetState& x, Time t) {
  FlightGoal goal;
  goal.t = t;
  goal.p_world_m << x[0], x[1], x[2];
  goal.v_world_m_s << x[4] * std::cos(x[3]), x[4] * std::sin(x[3]), 0;
  goal.a_world_m_s2 << -x[5] * goal.v_world_m_s.y(), x[5] * goal.v_world_m_s.x(), 0;
  goal.heading_rad = x[3];
  return goal;
}

double tilt_of(const core::AttitudeSetpoint& setpoint) {
  return std::acos((setpoint.q_world_body * Eigen::Vector3d::UnitZ()).z());
}

/// The largest distance from a goal on a CTRV course, from `settle_s` on.
struct Chase {
  double worst_m = 0;
  double worst_heading_rad = 0;
};

Chase chase(Plant& plant, TargetState x, double duration_s, double settle_s,
            const ControllerConfig& config = steady()) {
  Controller controller(config);
  Chase result;
  while (core::seconds(plant.state.t) < duration_s) {
    const auto setpoint = controller.step(plant.state, goal_of(x, plant.state.t));
    plant.fly(setpoint, kPicture);
    x = ctrv_predict(x, core::seconds(kPicture));
    if (core::seconds(plant.state.t) < settle_s) continue;
    result.worst_m = std::max(result.worst_m, (plant.state.p_world_body_m - x.head<3>()).norm());
    const Eigen::Vector3d forward = plant.state.q_world_body * Eigen::Vector3d::UnitX();
    result.worst_heading_rad =
        std::max(result.worst_heading_rad,
                 std::abs(std::remainder(std::atan2(forward.y(), forward.x()) - x[3],
                                         2 * std::numbers::pi)));
  }
  return result;
}

TEST(Controller, ComesToAPointAndStaysThere) {
  Plant plant;
  plant.state.p_world_body_m = {2, -1, 0.5};
  TargetState x = TargetState::Zero();
  x[2] = 1.5;
  // The integral's pole lies near 1.2 / 3 = 0.4 rad/s and holds a small share
  // of the way of 2.4 m: e^(-0.4 * 12) = 0.8 % of that.
  EXPECT_LT(chase(plant, x, 16, 12).worst_m, 0.01);
}

TEST(Controller, CatchesATargetThatDrivesStraight) {
  Plant plant;
  plant.state.p_world_body_m = {-1, 0, 1.5};
  TargetState x = TargetState::Zero();
  x << 0, 0, 1.5, 0.7, 0.6, 0;
  // Drag of 0.12 m/s^2 goes to the integral: what is left is its transient.
  EXPECT_LT(chase(plant, x, 16, 12).worst_m, 0.02);
}

TEST(Controller, StaysOverATargetThatTurns) {
  Plant plant;
  plant.state.p_world_body_m = {-1, 0, 1.5};
  TargetState x = TargetState::Zero();
  x << 0, 0, 1.5, 0.7, 0.6, 0.6;
  const Chase result = chase(plant, x, 20, 12);
  // The attitude lags 0.08 s behind a centripetal 0.36 m/s^2 that turns at 0.6
  // rad/s, and drag 0.12 m/s^2 turns with it: unbalanced 0.02 + 0.12 m/s^2 at
  // most, over gains of 1.4 * 3 per s^2 that is 3.3 cm.
  EXPECT_LT(result.worst_m, 0.04);
  // 0.08 s of 0.6 rad/s, and a picture's 0.01 s.
  EXPECT_LT(result.worst_heading_rad, 0.06);
}

TEST(Controller, LeansAgainstASteadyPush) {
  Plant plant;
  plant.state.p_world_body_m = {0, 0, 1.5};
  // Without an integral |wind| / (1.4 * 3) = 27 cm; e^(-0.4 * 12) of it is 2 mm.
  plant.wind_m_s2 = {0.8, -0.5, -0.6};
  TargetState x = TargetState::Zero();
  x[2] = 1.5;
  EXPECT_LT(chase(plant, x, 16, 12).worst_m, 0.01);
}

TEST(Controller, KeepsWithinTiltAndThrustHoweverFarTheGoal) {
  const ControllerConfig config = steady();
  Plant plant;
  Controller controller(config);
  FlightGoal goal;
  goal.p_world_m = {100, -50, 80};
  for (int i = 0; i < 500; ++i) {
    if (i == 250) goal.p_world_m *= -1;
    const auto setpoint = controller.step(plant.state, goal);
    EXPECT_LE(tilt_of(setpoint), config.max_tilt_deg * kRad_deg + 1e-9);  // rounding
    const double vertical = setpoint.thrust_m_s2 * std::cos(tilt_of(setpoint));
    EXPECT_GE(vertical, config.min_thrust_m_s2 - 1e-9);
    EXPECT_LE(vertical, config.max_thrust_m_s2 + 1e-9);
    plant.fly(setpoint, kPicture);
    // The speed limit, and what the lag lets it overshoot.
    EXPECT_LT(plant.state.v_world_body_m_s.head<2>().norm(), 1.3 * config.max_speed_m_s);
  }
}

TEST(Controller, TurnsTheShortWayAtALimitedRate) {
  Plant plant;
  plant.state.q_world_body = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ());
  Controller controller(steady());
  FlightGoal goal;
  goal.heading_rad = -3.0;
  double last_rad = 3.0, turned_rad = 0;
  for (int i = 0; i < 100; ++i) {
    const auto setpoint = controller.step(plant.state, goal);
    const Eigen::Vector3d forward = setpoint.q_world_body * Eigen::Vector3d::UnitX();
    const double heading_rad = std::atan2(forward.y(), forward.x());
    const double step_rad = std::remainder(heading_rad - last_rad, 2 * std::numbers::pi);
    EXPECT_LE(std::abs(step_rad), ControllerConfig{}.max_yaw_rate_rad_s * 0.01 + 1e-9);
    turned_rad += step_rad;
    last_rad = heading_rad;
    plant.state.t += kPicture;
  }
  EXPECT_NEAR(turned_rad, 2 * std::numbers::pi - 6, 1e-9);  // over pi, not back over zero
}

TEST(Controller, KeepsItsHeadingWhenNoneIsAsked) {
  Plant plant;
  plant.state.q_world_body = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ());
  Controller controller(steady());
  const auto setpoint = controller.step(plant.state, FlightGoal{});
  EXPECT_NEAR(setpoint.q_world_body.angularDistance(plant.state.q_world_body), 0, 1e-7);
  EXPECT_NEAR(setpoint.thrust_m_s2, 9.81, 1e-9);
}

TEST(Controller, StopsTheMotorsWhenTold) {
  Controller controller{ControllerConfig{}};
  FlightGoal goal;
  goal.motors_on = false;
  const auto setpoint = controller.step(core::VehicleState{}, goal);
  EXPECT_FALSE(setpoint.motors_on);
  EXPECT_EQ(setpoint.thrust_m_s2, 0);
}

TEST(Dither, GoesRoundAConeAtItsRate) {
  ControllerConfig config;
  config.dither_tilt_deg = 2;
  config.dither_rate_hz = 2.5;
  const Controller controller(config);
  for (int ms = 0; ms < 400; ms += 20) {
    const auto q = controller.dither(std::chrono::milliseconds(ms), std::nullopt);
    EXPECT_NEAR(Eigen::AngleAxisd(q).angle(), 2 * kRad_deg, 1e-9);  // rounding
    EXPECT_NEAR(q.z(), 0, 1e-12);                                   // no yaw
    EXPECT_LT(q.angularDistance(controller.dither(std::chrono::milliseconds(ms + 400), {})), 1e-6);
  }
  const auto half = controller.dither(std::chrono::milliseconds(200), {});
  EXPECT_NEAR(controller.dither(Time{}, {}).angularDistance(half), 4 * kRad_deg, 1e-6);
}

TEST(Dither, ShrinksTowardsTheBoardAndCanBeOff) {
  ControllerConfig config;
  const Controller controller(config);
  const auto angle = [&](double height_m) {
    return Eigen::AngleAxisd(controller.dither(Time{}, height_m)).angle() / kRad_deg;
  };
  EXPECT_NEAR(angle(config.dither_taper_height_m * 2), config.dither_tilt_deg, 1e-9);
  EXPECT_NEAR(angle(config.dither_taper_height_m / 2), config.dither_tilt_deg / 2, 1e-9);
  EXPECT_NEAR(angle(0), 0, 1e-9);
  EXPECT_NEAR(angle(-0.1), 0, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(Controller(steady()).dither(Time{}, {})).angle(), 0, 1e-12);
}

TEST(Dither, MovesTheVehicleRoundACircleOfTiltOverRateSquared) {
  ControllerConfig config;
  config.dither_tilt_deg = 2;
  config.dither_rate_hz = 3;
  Plant plant;
  plant.state.p_world_body_m = {0, 0, 1.5};
  TargetState x = TargetState::Zero();
  x[2] = 1.5;
  // g A / w^2 = 0.96 mm, of which the attitude's lag leaves 1 / sqrt(1 + w^2 T^2) = 0.55.
  const double omega_rad_s = 2 * std::numbers::pi * config.dither_rate_hz;
  const double lag = std::hypot(1, omega_rad_s * Plant::kAttitude_s);
  const double circle_m =
      9.81 * config.dither_tilt_deg * kRad_deg / (omega_rad_s * omega_rad_s * lag);
  // The velocity loop works against the circle's speed w r through the same lag: gain / (w lag)
  // of it. Drag of 0.2 / w = 1 % and the 10 ms that a setpoint holds are within the rest. The
  // integral's pole near 0.4 rad/s has forgotten the start by then, e^(-0.4 * 30).
  const double tolerance = 0.03 + config.velocity_gain_hz / (omega_rad_s * lag);
  EXPECT_NEAR(chase(plant, x, 32, 30, config).worst_m, circle_m, tolerance * circle_m);
}

TEST(Attitude, PutsBodyZAlongTheThrustAndBodyXOverTheHeading) {
  const Eigen::Vector3d f(1, -2, 9);
  const Eigen::Matrix3d R = attitude(f, 0.8).toRotationMatrix();
  EXPECT_LT((R.col(2) - f.normalized()).norm(), 1e-12);
  EXPECT_NEAR(R.col(1).dot(Eigen::Vector3d(std::cos(0.8), std::sin(0.8), 0)), 0, 1e-12);
  EXPECT_GT(R.col(0).dot(Eigen::Vector3d(std::cos(0.8), std::sin(0.8), 0)), 0.9);
}

TEST(Controller, RefusesAConfigOutOfRange) {
  ControllerConfig config;
  config.max_tilt_deg = 90;
  EXPECT_THROW(Controller{config}, std::invalid_argument);
}

TEST(Controller, TurnsLittleAfterAPause) {
  Controller controller(steady());
  Plant plant;
  FlightGoal goal;
  goal.heading_rad = 2.0;
  controller.step(plant.state, goal);
  plant.state.t += std::chrono::seconds(3);
  const auto setpoint = controller.step(plant.state, goal);
  const Eigen::Vector3d forward = setpoint.q_world_body * Eigen::Vector3d::UnitX();
  // The longest step counted is 0.15 s, at 1 rad/s; tilting changes it in the second order.
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.15, 0.02);
}

}  // namespace
}  // namespace nightjar::tracker
