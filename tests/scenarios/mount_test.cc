#include "scenarios/mount.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scenarios/processes.h"
#include "scenarios/scenario.h"
#include "sim/world.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MountTest, the_default_is_the_simulated_vehicles) {
  const std::string model = NIGHTJAR_SOURCE_DIR "/models/arena.xml";
  const sim::World world({}, {}, model, 1);
  // The world's goes through two poses of about 10 m in doubles.
  EXPECT_TRUE(T_body_camera({}).isApprox(world.T_body_camera(), 1e-12));
}

TEST(MountTest, turns_about_the_bodys_axes_one_after_the_other) {
  camera::MountConfig mount{{0.1, 0.02, -0.03}, {0.0, -45.0, 90.0}};
  const Eigen::Isometry3d T = T_body_camera(mount);
  EXPECT_EQ(T.translation(), Eigen::Vector3d(0.1, 0.02, -0.03));
  // Pitched nose up by 45 degrees it looks half forward, then turned to the left.
  const double half = std::numbers::sqrt2 / 2;
  EXPECT_TRUE(T.linear().col(2).isApprox(Eigen::Vector3d(0, half, -half), 1e-12));
  EXPECT_TRUE(T.linear().col(0).isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));  // picture's right
}

TEST(MountTest, the_simulator_does_not_take_one) {
  const std::string text = "model: ../models/arena.xml\nsource:\n  mount: ";
  const std::string file = NIGHTJAR_SOURCE_DIR "/scenarios/mounted.yaml";
  EXPECT_THAT(error_of([&] { parse(text + "{p_body_camera_m: [0, 0, -0.1]}\n", file); }),
              HasSubstr("mounted.yaml: source.mount differs from its defaults"));
  EXPECT_THAT(error_of([&] { parse(text + "{roll_pitch_yaw_deg: [0, 20, 0]}\n", file); }),
              HasSubstr("source.mount differs from its defaults"));
  EXPECT_EQ(parse(text + "{roll_pitch_yaw_deg: [0, 20, 0]}\n  type: caer\n", file)
                .source.mount.roll_pitch_yaw_deg[1],
            20.0);
}

TEST(MountTest, a_real_cameras_scenario_needs_no_model_and_is_saved_without_one) {
  const test::ScratchFolder folder;
  const Scenario scenario = parse("source: {type: caer}\n", folder.path() / "real.yaml");
  EXPECT_EQ(scenario.model, "");
  save(scenario, folder.path() / "saved.yaml");
  EXPECT_EQ(load(folder.path() / "saved.yaml").model, "");
  std::string estimates_sha256;
  EXPECT_TRUE(tracker_process(scenario, estimates_sha256).make_node);
  EXPECT_THAT(error_of([&] { parse("source: {type: simulation}\n", folder.path() / "a.yaml"); }),
              HasSubstr("model is not set"));
}

}  // namespace
}  // namespace nightjar::scenarios
