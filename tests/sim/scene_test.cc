#include "sim/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using testing::HasSubstr;

std::string error_of(const auto& action) {
  try {
    action();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Scene, MissingFileIsNamedInOneLine) {
  const std::string error = error_of([] { Scene("no_such_scene.xml"); });
  EXPECT_THAT(error, HasSubstr("no_such_scene.xml"));
  EXPECT_THAT(error, testing::Not(HasSubstr("\n")));
}

TEST(Scene, MissingElementIsNamedWithItsKind) {
  const Scene scene(test::arena());
  EXPECT_THAT(error_of([&] { scene.id(mjOBJ_CAMERA, "periscope"); }),
              HasSubstr("has no camera named 'periscope'"));
}

TEST(Scene, PlacedBodyIsWhereItWasPut) {
  Scene scene(test::arena());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(1, -2, 3);
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scene.place("uav", T);
  scene.settle();
  EXPECT_TRUE(scene.T_world_body(scene.id(mjOBJ_BODY, "uav")).isApprox(T, 1e-12));
}

TEST(Scene, VelocityOfAPointIsThatOfARigidBody) {
  Scene scene(test::arena());
  const int uav = scene.id(mjOBJ_BODY, "uav");
  mjtNum* v = scene.data()->qvel + scene.model()->jnt_dofadr[scene.id(mjOBJ_JOINT, "uav")];
  const Eigen::Vector3d linear(0.3, -0.2, 0.1), omega(0, 0, 2);  // MuJoCo: world, body
  for (int i = 0; i < 3; ++i) {
    v[i] = linear[i];
    v[i + 3] = omega[i];
  }
  scene.settle();
  const Eigen::Vector3d arm(0.5, 0, 0);
  const Eigen::Vector3d p = scene.T_world_body(uav).translation() + arm;
  EXPECT_LT((scene.velocity_at(uav, p) - (linear + omega.cross(arm))).norm(), 1e-12);
  EXPECT_LT((scene.omega_world(uav) - omega).norm(), 1e-12);
}

/// Where all geoms, cameras and lights are.
std::vector<double> poses(const mjModel& model, const mjData& data) {
  std::vector<double> all(data.geom_xpos, data.geom_xpos + 3 * model.ngeom);
  all.insert(all.end(), data.geom_xmat, data.geom_xmat + 9 * model.ngeom);
  all.insert(all.end(), data.cam_xpos, data.cam_xpos + 3 * model.ncam);
  all.insert(all.end(), data.cam_xmat, data.cam_xmat + 9 * model.ncam);
  all.insert(all.end(), data.light_xpos, data.light_xpos + 3 * model.nlight);
  all.insert(all.end(), data.light_xdir, data.light_xdir + 3 * model.nlight);
  return all;
}

TEST(Scene, AMomentAgoIsOnTheWayFromTheStepBefore) {
  Scene scene(test::arena());
  mjtNum* v = scene.data()->qvel + scene.model()->jnt_dofadr[scene.id(mjOBJ_JOINT, "uav")];
  for (int i = 0; i < 3; ++i) {  // thrown and tumbling
    v[i] = 2;
    v[i + 3] = 5;
  }
  for (int i = 0; i < 10; ++i) scene.step();
  const mjModel& model = *scene.model();
  const std::vector<double> before = poses(model, *scene.data());
  scene.step();
  const std::vector<double> now = poses(model, *scene.data());
  const double step_s = model.opt.timestep;
  const auto furthest = [](const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  ASSERT_GT(furthest(before, now), 9e-4);                                   // 2 m/s
  EXPECT_LT(furthest(poses(model, *scene.moment(step_s)), before), 1e-12);  // rounding
  EXPECT_LT(furthest(poses(model, *scene.moment(0)), now), 1e-12);
  std::vector<double> middle = before;
  for (std::size_t i = 0; i < now.size(); ++i) middle[i] = (before[i] + now[i]) / 2;
  // A turn of 9 rad/s bends away from the chord by (9 * 0.25 ms)^2 / 2.
  EXPECT_LT(furthest(poses(model, *scene.moment(step_s / 2)), middle), 2.6e-6);
  EXPECT_EQ(poses(model, *scene.data()), now);  // untouched
}

TEST(Scene, DivergedPhysicsThrowsAndLeavesNoLogFile) {
  std::filesystem::remove("MUJOCO_LOG.TXT");
  Scene scene(test::arena());
  scene.step();
  scene.data()->qvel[0] = std::numeric_limits<double>::quiet_NaN();
  try {
    scene.step();
    FAIL() << "went on";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("QVEL"));
    EXPECT_THAT(e.what(), HasSubstr("0.0005"));  // the arena's time step: one was taken
  }
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(Scene, MuJoCosOwnErrorsAreThrown) {
  const Scene scene(test::arena());
  try {
    mju_error("no such thing");
    FAIL() << "went on";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "MuJoCo: no such thing");
  }
}

}  // namespace
}  // namespace nightjar::sim
