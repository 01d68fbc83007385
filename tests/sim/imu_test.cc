#include "sim/imu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "sim/world.h"
#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDt_s = 1e-3;
constexpr double kRad = std::numbers::pi / 180;
constexpr double kG_m_s2 = 9.80665;
constexpr int kSeeds = 400;
const Vector3d kGravity(0, 0, -9.81);

/// Neither noise nor bias; what remains is the rounding to 16 bits.
ImuConfig perfect() {
  ImuConfig config;
  config.gyro_noise_deg_s_sqrt_hz = config.accel_noise_ug_sqrt_hz = 0;
  config.gyro_bias_sigma_deg_s = config.accel_bias_sigma_mg = 0;
  config.gyro_drift_sigma_deg_s = config.accel_drift_sigma_mg = 0;
  return config;
}

double gyro_unit(const ImuConfig& config) { return kRad * config.gyro_range_deg_s / 32768; }
double accel_unit(const ImuConfig& config) { return kG_m_s2 * config.accel_range_g / 32768; }

Quaterniond turned(const Vector3d& vector_rad) {
  return Quaterniond(Eigen::AngleAxisd(vector_rad.norm(), vector_rad.stableNormalized()));
}

/// Samples of a camera that moves as `motion(t_s)` says.
std::vector<core::ImuSample> samples(const ImuConfig& config, const Vector3d& gravity, int n,
                                     std::uint64_t seed,
                                     const std::function<CameraMotion(double)>& motion) {
  Imu imu(config, gravity, motion(0), seed);
  std::vector<core::ImuSample> all;
  for (int i = 1; i <= n; ++i) all.push_back(imu.next(motion(i * kDt_s)));
  return all;
}

std::vector<core::ImuSample> still(const ImuConfig& config, int n, std::uint64_t seed) {
  return samples(config, Vector3d::Zero(), n, seed, [](double) { return CameraMotion{}; });
}

/// Six channels in units of 1: gyroscope x, y, z, accelerometer x, y, z.
double channel(const core::ImuSample& sample, int i) {
  return i < 3 ? sample.omega_camera_rad_s[i] : sample.specific_force_camera_m_s2[i - 3];
}

double deviation(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));  // the mean is known to be 0
}

TEST(Imu, at_rest_it_feels_gravity_upwards) {
  Eigen::Matrix3d R_world_camera;  // looking down, the picture's top to the east
  R_world_camera << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  const CameraMotion at_rest{Quaterniond(R_world_camera), Vector3d::Zero()};
  for (const auto& sample : samples(perfect(), kGravity, 10, 1, [&](double) { return at_rest; })) {
    EXPECT_TRUE(sample.omega_camera_rad_s.isZero());
    EXPECT_LE((sample.specific_force_camera_m_s2 - Vector3d(0, 0, -9.81)).cwiseAbs().maxCoeff(),
              0.5 * accel_unit(perfect()));  // rounding
  }
}

TEST(Imu, times_are_whole_milliseconds) {
  const auto all = still({}, 2000, 1);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].t, (i + 1) * 1ms);
}

TEST(Imu, a_turn_gives_its_rate_in_the_cameras_axes) {
  const Quaterniond start = turned({0.3, -1.1, 2.0});
  for (const Vector3d& rate : {Vector3d(3, 0, 0), Vector3d(0, -3, 0), Vector3d(0, 0, 8),
                               Vector3d(-1, 2, 0.5), Vector3d(1e-3, 0, 0)})
    for (const auto& sample : samples(perfect(), kGravity, 50, 1, [&](double t_s) {
           return CameraMotion{start * turned(rate * t_s), Vector3d::Zero()};
         }))
      EXPECT_LE((sample.omega_camera_rad_s - rate).cwiseAbs().maxCoeff(),
                0.501 * gyro_unit(perfect()))  // rounding, and that of `motion`
          << rate.transpose();
}

TEST(Imu, in_free_fall_it_feels_nothing) {
  for (const auto& sample : samples(perfect(), kGravity, 500, 1, [](double t_s) {
         return CameraMotion{turned({0, 2 * t_s, 0}), kGravity * t_s};
       }))
    EXPECT_LE(sample.specific_force_camera_m_s2.cwiseAbs().maxCoeff(), 0.5 * accel_unit(perfect()));
}

TEST(Imu, a_lever_arm_adds_the_centripetal_acceleration) {
  const Vector3d omega(0, 0, 8), arm_camera_m(0.5, 0, 0.1);
  for (const auto& sample : samples(perfect(), Vector3d::Zero(), 300, 1, [&](double t_s) {
         const Quaterniond q = turned(omega * t_s);
         return CameraMotion{q, omega.cross(q * arm_camera_m)};
       }))
    // 64/s^2 * 0.5 m towards the axis; the mean over a chord of 8 mrad is 3e-6 of it off.
    EXPECT_LE((sample.specific_force_camera_m_s2 - Vector3d(-32, 0, 0)).cwiseAbs().maxCoeff(),
              0.5 * accel_unit(perfect()) + 32 * 3e-6);
}

TEST(Imu, white_noise_has_the_configured_density) {
  ImuConfig config = perfect();
  config.gyro_noise_deg_s_sqrt_hz = 0.01;
  config.accel_noise_ug_sqrt_hz = 300;
  constexpr int kN = 20000;
  const auto all = still(config, kN, 11);
  for (int i = 0; i < 6; ++i) {
    // One-sided density up to half of 1 kHz, and rounding.
    const double white = i < 3 ? 0.01 * kRad * std::sqrt(500) : 300e-6 * kG_m_s2 * std::sqrt(500);
    const double unit = i < 3 ? gyro_unit(config) : accel_unit(config);
    const double expected = std::hypot(white, unit / std::sqrt(12));
    std::vector<double> values;
    double neighbours = 0;
    for (const auto& sample : all) {
      if (!values.empty()) neighbours += values.back() * channel(sample, i);
      values.push_back(channel(sample, i));
    }
    EXPECT_NEAR(deviation(values), expected, 5 * expected / std::sqrt(2.0 * kN)) << i;
    EXPECT_NEAR(neighbours / kN, 0, 5 * expected * expected / std::sqrt(kN)) << i;
  }
}

TEST(Imu, the_bias_is_constant_and_drawn_anew_for_each_seed) {
  ImuConfig config = perfect();
  config.gyro_bias_sigma_deg_s = 1.7;
  config.accel_bias_sigma_mg = 20;
  std::vector<double> gyro, accel;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto all = still(config, 5, seed);
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(channel(all.front(), i), channel(all.back(), i));
      (i < 3 ? gyro : accel).push_back(channel(all.front(), i));
    }
  }
  const double n = 3 * kSeeds;
  for (const auto& [values, sigma] : {std::pair{gyro, 1.7 * kRad}, {accel, 0.02 * kG_m_s2}}) {
    EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0) / n, 0,
                5 * sigma / std::sqrt(n));
    EXPECT_NEAR(deviation(values), sigma, 5 * sigma / std::sqrt(2 * n));
  }
}

TEST(Imu, the_drift_is_stationary_and_forgets_at_its_correlation_time) {
  ImuConfig config = perfect();
  config.gyro_drift_sigma_deg_s = 1;
  config.accel_drift_sigma_mg = 50;
  config.drift_correlation_s = 0.1;
  std::vector<double> before[2], after[2];
  double product[2] = {0, 0};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto all = still(config, 101, seed);  // one correlation time from first to last
    for (int i = 0; i < 6; ++i) {
      before[i / 3].push_back(channel(all.front(), i));
      after[i / 3].push_back(channel(all.back(), i));
      product[i / 3] += channel(all.front(), i) * channel(all.back(), i);
    }
  }
  const double n = 3 * kSeeds;
  for (const int kind : {0, 1}) {
    const double sigma = kind == 0 ? kRad : 0.05 * kG_m_s2;
    EXPECT_NEAR(deviation(before[kind]), sigma, 5 * sigma / std::sqrt(2 * n));
    EXPECT_NEAR(deviation(after[kind]), sigma, 5 * sigma / std::sqrt(2 * n));
    // The product of two normal values of correlation r deviates by sqrt(1 + r^2).
    const double r = std::exp(-1);
    EXPECT_NEAR(product[kind] / n / (sigma * sigma), r, 5 * std::sqrt((1 + r * r) / n));
  }
}

TEST(Imu, readings_are_whole_units_of_sixteen_bits) {
  for (const auto& sample : still({}, 200, 3))
    for (int i = 0; i < 6; ++i) {
      const double units = channel(sample, i) / (i < 3 ? gyro_unit({}) : accel_unit({}));
      EXPECT_NEAR(units, std::round(units), 1e-9);
    }
}

TEST(Imu, readings_saturate_at_the_range) {
  const Vector3d rate(20, -20, 0), acceleration(-60, 60, 0);
  const auto all = samples(perfect(), Vector3d::Zero(), 1, 1, [&](double t_s) {
    return CameraMotion{turned(rate * t_s), acceleration * t_s};
  });
  const double gyro = 500 * kRad, accel = 4 * kG_m_s2;
  // The range's upper end is one unit short of the lower, as two's complement has it.
  EXPECT_NEAR(all[0].omega_camera_rad_s.x(), gyro - gyro_unit(perfect()), 1e-12);
  EXPECT_NEAR(all[0].omega_camera_rad_s.y(), -gyro, 1e-12);
  EXPECT_NEAR(all[0].specific_force_camera_m_s2.x(), -accel, 1e-12);
  EXPECT_NEAR(all[0].specific_force_camera_m_s2.y(), accel - accel_unit(perfect()), 1e-12);
}

TEST(Imu, the_same_seed_gives_the_same_bits) {
  const auto a = still({}, 300, 5), b = still({}, 300, 5), c = still({}, 300, 6);
  int differ = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(channel(a[k], i), channel(b[k], i));
      differ += channel(a[k], i) != channel(c[k], i);
    }
  EXPECT_GT(differ, 1500);  // of 1800; a few are rounded to the same unit
}

constexpr double ImuConfig::*kEffects[] = {
    &ImuConfig::gyro_noise_deg_s_sqrt_hz, &ImuConfig::accel_noise_ug_sqrt_hz,
    &ImuConfig::gyro_bias_sigma_deg_s,    &ImuConfig::accel_bias_sigma_mg,
    &ImuConfig::gyro_drift_sigma_deg_s,   &ImuConfig::accel_drift_sigma_mg};

TEST(Imu, no_effect_repeats_anothers_draws) {
  std::vector<std::vector<double>> draws;  // of each effect: three axes, all seeds
  for (double ImuConfig::*effect : kEffects) {
    ImuConfig alone = perfect();
    alone.*effect = 1;
    alone.accel_range_g = 0.1;  // 1 ug/sqrt(Hz) makes 22 ug: 7 units
    auto& own = draws.emplace_back();
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const core::ImuSample sample = still(alone, 1, seed).front();
      for (int i = 0; i < 3; ++i)
        own.push_back(sample.omega_camera_rad_s[i] + sample.specific_force_camera_m_s2[i]);
    }
  }
  for (std::size_t a = 0; a < draws.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const double product =
          std::inner_product(draws[a].begin(), draws[a].end(), draws[b].begin(), 0.0) /
          (3 * kSeeds);
      EXPECT_NEAR(product / (deviation(draws[a]) * deviation(draws[b])), 0,
                  5 / std::sqrt(3 * kSeeds))
          << a << ' ' << b;
    }
}

TEST(Imu, switching_an_effect_off_leaves_the_draws_of_all_others) {
  ImuConfig all_on;
  all_on.gyro_drift_sigma_deg_s = 0.5;
  all_on.accel_drift_sigma_mg = 5;
  const ImuConfig none = perfect();
  for (double ImuConfig::*effect : kEffects) {
    ImuConfig without = all_on, alone = none;
    without.*effect = 0;
    alone.*effect = all_on.*effect;
    const auto a = still(all_on, 200, 7), b = still(without, 200, 7), c = still(alone, 200, 7);
    double moved = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
      for (int i = 0; i < 6; ++i) {
        const double unit = i < 3 ? gyro_unit(all_on) : accel_unit(all_on);
        // Effects add up; each of the three readings is rounded.
        EXPECT_NEAR(channel(a[k], i) - channel(b[k], i), channel(c[k], i), 1.5001 * unit);
        moved = std::max(moved, std::abs(channel(c[k], i)) / unit);
      }
    EXPECT_GT(moved, 8) << "an effect too weak to tell";
  }
}

TEST(Imu, bad_configurations_are_refused) {
  EXPECT_THROW(still({.gyro_range_deg_s = 0}, 1, 1), std::invalid_argument);
  EXPECT_THROW(still({.accel_noise_ug_sqrt_hz = -1}, 1, 1), std::invalid_argument);
}

WorldConfig beside_the_ugv(double height_m) {
  WorldConfig config;
  config.start_from_tag_m = {0, 0, height_m};
  config.ugv.course = {{-5, -3, 0.0, CoursePhase::straight}, {5, -3, 0.0, CoursePhase::straight}};
  return config;
}

std::vector<core::ImuSample> fly(World& world, core::Time duration) {
  for (const core::Time end = world.now() + duration; world.now() < end;) world.step();
  return world.take_imu();
}

core::AttitudeSetpoint motors_off() {
  core::AttitudeSetpoint setpoint;
  setpoint.motors_on = false;
  return setpoint;
}

TEST(ImuInWorld, standing_on_the_board_it_feels_gravity_within_noise) {
  World world(beside_the_ugv(0.12), CameraConfig{}, test::arena(), 1);
  world.command(motors_off());
  fly(world, 800ms);
  const auto all = fly(world, 200ms);
  ASSERT_EQ(all.size(), 200u);
  EXPECT_EQ(all.front().t, 801ms);
  const Vector3d up = world.truth().T_world_camera.linear().transpose() * Vector3d(0, 0, 9.81);
  Vector3d force = Vector3d::Zero(), rate = Vector3d::Zero();
  for (const auto& sample : all) {
    force += sample.specific_force_camera_m_s2 / 200;
    rate += sample.omega_camera_rad_s / 200;
  }
  EXPECT_LT(up.z(), -9.8);  // the camera looks down
  // 5 deviations of the bias; the noise of 200 samples is small beside it.
  EXPECT_LT((force - up).cwiseAbs().maxCoeff(), 5 * 0.02 * kG_m_s2);
  EXPECT_LT(rate.cwiseAbs().maxCoeff(), 5 * 1.7 * kRad);
}

TEST(ImuInWorld, falling_with_still_rotors_it_feels_nothing) {
  WorldConfig config = beside_the_ugv(3.0);
  config.quadrotor.drag_xy_n_s_m = config.quadrotor.drag_z_n_s_m = 0;
  World world(config, CameraConfig{}, test::arena(), 1, perfect());
  world.command(motors_off());
  fly(world, 250ms);  // thrust falls by e every 15 ms: 5e-7 m/s^2 are left
  for (const auto& sample : fly(world, 200ms))
    EXPECT_LE(sample.specific_force_camera_m_s2.cwiseAbs().maxCoeff(), 0.5 * accel_unit(perfect()));
}

TEST(ImuInWorld, integrated_samples_follow_the_cameras_true_attitude_and_velocity) {
  World world(beside_the_ugv(3.0), CameraConfig{}, test::arena(), 1, perfect());
  core::AttitudeSetpoint swing;
  swing.thrust_m_s2 = 12;
  swing.q_world_body = turned({0.5, -0.4, 1.0});
  world.command(swing);
  const auto velocity = [&] {  // of the camera, by the rigid body's motion
    const core::Truth truth = world.truth();
    const Vector3d omega_world = truth.uav.q_world_body * truth.uav.omega_body_rad_s;
    return Vector3d(
        truth.uav.v_world_body_m_s +
        omega_world.cross(truth.T_world_camera.translation() - truth.uav.p_world_body_m));
  };
  Quaterniond q(world.truth().T_world_camera.linear());
  Vector3d v = velocity();
  for (const auto& sample : fly(world, 400ms)) {
    const Quaterniond middle = q * turned(sample.omega_camera_rad_s * (kDt_s / 2));
    q = q * turned(sample.omega_camera_rad_s * kDt_s);
    v += (middle * sample.specific_force_camera_m_s2 + kGravity) * kDt_s;
  }
  const Quaterniond truth(world.truth().T_world_camera.linear());
  // Rounding alone: 400 steps of an error of unit/sqrt(12) for 1 ms, times 5; it tilts
  // gravity, too, which is below 4e-4 m/s.
  EXPECT_LT(q.angularDistance(truth), 5 * std::sqrt(3 * 400 / 12.0) * gyro_unit({}) * kDt_s);
  EXPECT_LT((v - velocity()).norm(), 5 * std::sqrt(3 * 400 / 12.0) * accel_unit({}) * kDt_s + 4e-4);
  EXPECT_GT(q.angularDistance(Quaterniond(1, 0, 0, 0)), 0.5);
}

}  // namespace
}  // namespace nightjar::sim
