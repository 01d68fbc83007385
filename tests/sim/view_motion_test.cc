#include "sim/view_motion.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/support/scratch_folder.h"

namespace nightjar::sim {
namespace {

// A floor under a camera 2 m up, a crate of 0.5 m and, on the UAV's own group, a leg.
constexpr const char* kModel = R"(<mujoco><worldbody>
  <geom name="floor" type="plane" size="0 0 1" pos="0 0 0" contype="0" conaffinity="0"/>
  <geom name="leg" type="box" size="0.1 0.1 0.1" pos="0 0 1.8" group="1"/>
  <body name="crate" pos="CRATE 0 0.25"><freejoint name="crate"/>
    <geom type="box" size="0.2 0.2 0.25" mass="1"/></body>
</worldbody></mujoco>)";

constexpr core::CameraModel kCamera{{346, 260}, 300, 300, 172.5, 129.5};

double fastest_with_crate_at(const std::string& x_m, double crate_v_m_s = 0) {
  const test::ScratchFolder scratch;
  std::string model = kModel;
  model.replace(model.find("CRATE"), 5, x_m);
  std::ofstream(scratch / "scene.xml") << model;
  Scene scene(scratch / "scene.xml");
  scene.data()->qvel[1] = crate_v_m_s;
  scene.settle();
  MovingCamera camera{Eigen::Isometry3d::Identity(), {0.5, 0, 0}, Eigen::Vector3d::Zero()};
  camera.T_world_camera.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.T_world_camera.translation().z() = 2;
  return ViewMotion(scene).fastest_px_s(scene, kCamera, camera);
}

TEST(ViewMotion, counts_the_floor_when_nothing_else_is_in_view) {
  EXPECT_NEAR(fastest_with_crate_at("30"), 300 * 0.5 / 2.0, 1e-6);
}

TEST(ViewMotion, what_stands_higher_moves_faster) {
  EXPECT_NEAR(fastest_with_crate_at("0"), 300 * 0.5 / 1.5, 1e-6);
}

TEST(ViewMotion, what_moves_counts_with_its_own_velocity) {
  EXPECT_NEAR(fastest_with_crate_at("0", 2.0), 300 * std::hypot(0.5, 2.0) / 1.5, 1e-6);
}

TEST(ViewMotion, the_spin_of_a_plain_wheel_does_not_show) {
  const test::ScratchFolder scratch;
  std::ofstream(scratch / "scene.xml") << R"(<mujoco><worldbody>
    <body name="wheel" pos="0 0 0.5"><freejoint/>
      <geom type="cylinder" size="0.1 0.02" mass="1"/></body></worldbody></mujoco>)";
  Scene scene(scratch / "scene.xml");
  MovingCamera camera{Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(),
                      Eigen::Vector3d::Zero()};
  camera.T_world_camera.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.T_world_camera.translation().z() = 2;
  const ViewMotion motion(scene);
  scene.data()->qvel[5] = 20;  // about its axis
  scene.settle();
  EXPECT_NEAR(motion.fastest_px_s(scene, kCamera, camera), 0, 1e-9);
  scene.data()->qvel[3] = 20;  // and it tumbles
  scene.settle();
  EXPECT_GT(motion.fastest_px_s(scene, kCamera, camera), 100);
}

}  // namespace
}  // namespace nightjar::sim
