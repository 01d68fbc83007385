#include "sim/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

core::AttitudeSetpoint hover() {
  core::AttitudeSetpoint setpoint;
  setpoint.thrust_m_s2 = 9.81;
  return setpoint;
}

std::unique_ptr<Simulation> make(std::uint64_t seed, RendererConfig renderer = {}) {
  WorldConfig world;
  world.renderer = renderer;
  world.ugv.course = {{-5, -3, 0.4, CoursePhase::straight}, {5, -3, 0.4, CoursePhase::straight}};
  return std::make_unique<Simulation>(world, CameraConfig{}, SensorConfig{}, test::arena(), 5.0,
                                      seed);
}

TEST(Simulation, PacketsFollowEachOtherWithoutGapAndHoldTheirEvents) {
  const auto simulation = make(1);
  core::Time end{};
  for (int i = 0; i < 5; ++i) {
    const SimulationStep step = simulation->advance(hover());
    EXPECT_EQ(step.packet.begin, end);
    EXPECT_EQ(step.packet.end, end + 10ms);
    EXPECT_EQ(step.truth.t, step.packet.end);
    EXPECT_EQ(step.vehicle.t, step.packet.end);
    ASSERT_FALSE(step.packet.events.empty());
    EXPECT_GT(step.packet.events.front().t, step.packet.begin);
    EXPECT_LE(step.packet.events.back().t, step.packet.end);
    EXPECT_TRUE(std::is_sorted(step.packet.events.begin(), step.packet.events.end(),
                               [](const auto& a, const auto& b) { return a.t < b.t; }));
    end = step.packet.end;
  }
}

TEST(Simulation, SameSeedSameBits) {
  const auto a = make(3), b = make(3), other = make(4);
  for (int i = 0; i < 3; ++i) {
    const SimulationStep from_a = a->advance(hover()), from_b = b->advance(hover());
    EXPECT_EQ(from_a.packet.events, from_b.packet.events);
    EXPECT_EQ(from_a.vehicle.p_world_body_m, from_b.vehicle.p_world_body_m);
    EXPECT_NE(from_a.packet.events, other->advance(hover()).packet.events);
  }
}

TEST(Simulation, ApsFramesTakeTheExposureThatTheLightNeeds) {
  const auto simulation = make(1);
  std::vector<core::ApsFrame> frames;
  for (int i = 0; i < 55; ++i)
    for (auto& frame : simulation->advance(hover()).frames) frames.push_back(frame);
  ASSERT_EQ(frames.size(), 1u);  // 0.5 s at 5 lux, by the ESI paper
  EXPECT_EQ(frames[0].exposure_end - frames[0].exposure_begin, 500ms);
}

TEST(Simulation, CountsWhatIsDrawnTooLate) {
  RendererConfig strict;
  strict.max_motion_px = 0.05;
  const auto usual = make(1), late = make(1, strict);
  core::AttitudeSetpoint tilting = hover();
  tilting.q_world_body = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  for (int i = 0; i < 15; ++i) {
    usual->advance(tilting);
    late->advance(tilting);
  }
  EXPECT_EQ(usual->drawn_late(), 0u);  // 0.5 px in half a millisecond are 1000 px/s
  EXPECT_GT(late->drawn_late(), 0u);   // here, 100 px/s: 0.1 rad (30 px) in 0.15 s are more
  EXPECT_LE(late->drawn_late(), late->renders());
}

TEST(Simulation, ImuSamplesFollowEachOtherEveryMillisecond) {
  const auto simulation = make(1);
  core::Time t{};
  for (int i = 0; i < 3; ++i)
    for (const core::ImuSample& sample : simulation->advance(hover()).imu) {
      t += 1ms;
      EXPECT_EQ(sample.t, t);
    }
  EXPECT_EQ(t, 30ms);
}

TEST(Simulation, StageTimesCountEveryRender) {
  const auto simulation = make(1);
  simulation->advance(hover());
  std::map<std::string, std::uint64_t> calls;
  for (const core::StageTime& time : simulation->stage_times()) calls[time.stage] = time.calls;
  EXPECT_EQ(calls.at("draw"), simulation->renders());
  EXPECT_EQ(calls.at("emulate pixels"), simulation->renders());
  EXPECT_GT(calls.at("step physics"), 0u);
}

TEST(Simulation, DrawsMoreOftenWhenMoreMoves) {
  RendererConfig coarse;
  coarse.max_motion_px = 4.0;
  const auto fine = make(1), rough = make(1, coarse);
  core::AttitudeSetpoint tilting = hover();
  tilting.q_world_body = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  for (int i = 0; i < 30; ++i) {
    fine->advance(tilting);
    rough->advance(tilting);
  }
  EXPECT_GT(fine->renders(), rough->renders());
  EXPECT_GE(rough->renders(), 60u);  // 5 ms at most between two
}

core::AttitudeSetpoint tilting(double tilt_rad) {
  core::AttitudeSetpoint setpoint = hover();
  setpoint.q_world_body = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY());
  return setpoint;
}

/// Packets that were each taken after the next had been flown, but for the last.
std::vector<SimulationStep> flown_ahead(Simulation& simulation, int packets) {
  std::vector<SimulationStep> taken;
  simulation.fly(tilting(0.3));
  for (int i = 1; i < packets; ++i) {
    simulation.fly(tilting(0.3));
    taken.push_back(simulation.take());
  }
  taken.push_back(simulation.take());
  return taken;
}

void expect_complete(const SimulationStep& step, core::Time begin, core::Time end) {
  EXPECT_EQ(step.packet.begin, begin);
  EXPECT_EQ(step.packet.end, end);
  EXPECT_EQ(step.truth.t, end);
  EXPECT_EQ(step.vehicle.t, end);
  ASSERT_EQ(step.imu.size(), static_cast<std::size_t>((end - begin) / 1ms));
  EXPECT_EQ(step.imu.back().t, end);
  for (const core::Event& event : step.packet.events) {
    ASSERT_GT(event.t, begin);
    ASSERT_LE(event.t, end);
  }
  for (const core::ApsFrame& frame : step.frames) {
    EXPECT_GT(frame.exposure_end, begin);
    EXPECT_LE(frame.exposure_end, end);
  }
}

TEST(Simulation, FlyingAheadDrawsLessThanLookingAtTheEndOfEveryPacket) {
  const auto ahead = make(1), looking = make(1);
  const std::vector<SimulationStep> steps = flown_ahead(*ahead, 20);
  for (int i = 0; i < 20; ++i) {
    looking->advance(tilting(0.3));
    expect_complete(steps[static_cast<std::size_t>(i)], i * 10ms, (i + 1) * 10ms);
    EXPECT_FALSE(steps[static_cast<std::size_t>(i)].packet.events.empty());
  }
  EXPECT_LT(ahead->renders(), looking->renders());
}

TEST(Simulation, FlyingAheadSameSeedSameBits) {
  const auto a = make(3), b = make(3);
  const auto from_a = flown_ahead(*a, 8), from_b = flown_ahead(*b, 8);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(from_a[i].packet.events, from_b[i].packet.events);
}

TEST(Simulation, ExposingEarlyChangesNothing) {
  const auto late = make(3), early = make(3);
  late->fly(hover());
  early->fly(hover());
  for (int i = 0; i < 5; ++i) {
    early->expose_looked();
    late->fly(hover());
    early->fly(hover());
    EXPECT_EQ(early->take().packet.events, late->take().packet.events);
  }
}

TEST(Simulation, PacketsMayBeShorterThanPicturesAreApart) {
  RendererConfig rare;
  rare.max_motion_px = 20;
  rare.max_interval_ms = 100;
  CameraConfig camera;
  camera.packet_interval_ms = 1;
  WorldConfig world;
  world.renderer = rare;
  Simulation simulation(world, camera, SensorConfig{}, test::arena(), 5.0, 1);
  const std::vector<SimulationStep> steps = flown_ahead(simulation, 30);
  for (int i = 0; i < 30; ++i)
    expect_complete(steps[static_cast<std::size_t>(i)], i * 1ms, (i + 1) * 1ms);
  // At most one for each packet's end, and the first.
  EXPECT_LE(simulation.renders(), 31u);
}

TEST(RenderInterval, is_before_the_motion_is_too_much_but_a_step_at_least) {
  const RendererConfig config;  // 0.5 px, 5 ms
  EXPECT_EQ(render_interval(config, 0.0, 500us), 5ms);
  EXPECT_EQ(render_interval(config, 100.0, 500us), 5ms);
  EXPECT_EQ(render_interval(config, 125.0, 500us), 4ms);
  EXPECT_EQ(render_interval(config, 126.0, 500us), 3968us);
  EXPECT_EQ(render_interval(config, 1e5, 500us), 500us);
  EXPECT_EQ(render_interval(config, std::numeric_limits<double>::infinity(), 500us), 500us);
}

TEST(Simulation, PacketIntervalMustBeWholePhysicsSteps) {
  CameraConfig camera;
  camera.packet_interval_ms = 10.3;
  try {
    Simulation simulation(WorldConfig{}, camera, SensorConfig{}, test::arena(), 5.0, 1);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("camera.packet_interval_ms = 10.3"));
  }
}

}  // namespace
}  // namespace nightjar::sim
