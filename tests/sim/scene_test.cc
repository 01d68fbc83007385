#include "sim/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <limits>

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
