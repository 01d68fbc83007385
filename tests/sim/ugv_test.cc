#include "sim/ugv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

UgvConfig straight(double speed_m_s) {
  UgvConfig config;
  config.course = {{0, -3, speed_m_s, CoursePhase::straight},
                   {2, -3, speed_m_s, CoursePhase::turning},
                   {2, -1, speed_m_s, CoursePhase::landing}};
  return config;
}

class UgvTest : public testing::Test {
 protected:
  void start(const UgvConfig& config) {
    ugv_.emplace(config, scene_);
    scene_.place("ugv", ugv_->T_world_start(0.085));
    scene_.settle();
  }
  void drive(double duration_s) {
    const double dt_s = scene_.model()->opt.timestep;
    for (long left = std::lround(duration_s / dt_s); left > 0; --left) {
      ugv_->drive(dt_s, scene_);
      scene_.step();
    }
  }
  Eigen::Vector3d place() const { return scene_.T_world_body(ugv_->body()).translation(); }
  double speed() const { return scene_.velocity_at(ugv_->body(), place()).head<2>().norm(); }

  Scene scene_{test::arena()};
  std::optional<Ugv> ugv_;
};

TEST_F(UgvTest, ReachesTheSpeedOfItsLeg) {
  start(straight(0.4));
  drive(3.0);
  // Wheels slip a little under the rolling resistance of their contacts.
  EXPECT_NEAR(speed(), 0.4, 0.01);
  EXPECT_NEAR(place().y(), -3.0, 0.005);
}

TEST_F(UgvTest, TurnsOnToTheNextLegAndStopsAtTheEnd) {
  start(straight(0.4));
  EXPECT_EQ(ugv_->phase(), CoursePhase::straight);
  drive(8.0);
  EXPECT_EQ(ugv_->phase(), CoursePhase::turning);
  EXPECT_FALSE(ugv_->finished());
  drive(6.0);
  EXPECT_TRUE(ugv_->finished());
  EXPECT_LT(speed(), 0.01);
  // Pure pursuit cuts the corner by less than its lookahead (0.5 m) and is back on the
  // line at the end; it comes to rest within v^2 / 2a = 0.16 m of it.
  EXPECT_NEAR(place().x(), 2.0, 0.1);
  EXPECT_NEAR(place().y(), -1.0, 0.25);
}

TEST_F(UgvTest, CoincidingWaypointsAreRefused) {
  UgvConfig config = straight(0.4);
  config.course[1] = config.course[0];
  try {
    Ugv ugv(config, scene_);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("ugv.course[1]"));
  }
}

}  // namespace
}  // namespace nightjar::sim
