#include "sim/carried_camera.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

CarriedCamera make(CarryMotion motion, std::uint64_t seed, const CameraConfig& camera = {}) {
  return CarriedCamera(camera, SensorConfig{}, RendererConfig{}, test::arena(), 5.0, motion, seed);
}

/// What the picture shows at a point of the tag's plane, (x, y) from its middle.
float luminance_at(const CarriedStep& step, const core::CameraModel& model, double x_m,
                   double y_m) {
  const Eigen::Isometry3d T_camera_tag =
      step.truth.T_world_camera.inverse() * step.truth.T_world_tag;
  const auto pixel = model.project(T_camera_tag * Eigen::Vector3d(x_m, y_m, 0));
  EXPECT_TRUE(pixel && model.contains(*pixel, 1));
  return step.luminance_lux(static_cast<int>(std::lround(pixel->x())),
                            static_cast<int>(std::lround(pixel->y())));
}

TEST(CarriedCamera, sees_the_tag_where_the_truth_has_it) {
  CarriedCamera camera = make(CarryMotion::slow, /*seed=*/1);
  for (int i = 0; i < 3; ++i) {
    const CarriedStep step = camera.next();
    // The black square's rim is a cell of 30 mm wide, and so is the white one around it:
    // their middles are 105 and 135 mm from the tag's.
    for (const double side : {-1.0, 1.0})
      for (const double along_m : {-0.06, 0.0, 0.06}) {
        EXPECT_LT(luminance_at(step, camera.model(), side * 0.105, along_m), 1.0f);
        EXPECT_LT(luminance_at(step, camera.model(), along_m, side * 0.105), 1.0f);
        EXPECT_GT(luminance_at(step, camera.model(), side * 0.135, along_m), 2.0f);
        EXPECT_GT(luminance_at(step, camera.model(), along_m, side * 0.135), 2.0f);
      }
  }
}

TEST(CarriedCamera, packets_end_at_multiples_of_their_interval_and_hold_their_events) {
  CameraConfig config;
  config.packet_interval_ms = 7;
  CarriedCamera camera = make(CarryMotion::fast, /*seed=*/2, config);
  std::size_t events = 0;
  for (int i = 0; i < 5; ++i) {
    const CarriedStep step = camera.next();
    EXPECT_EQ(step.packet.begin, i * 7ms);
    EXPECT_EQ(step.packet.end, (i + 1) * 7ms);
    EXPECT_EQ(step.truth.t, step.packet.end);
    for (const core::Event& e : step.packet.events) {
      EXPECT_GT(e.t, step.packet.begin);
      EXPECT_LE(e.t, step.packet.end);
    }
    events += step.packet.events.size();
  }
  EXPECT_GT(events, 1000u);
}

TEST(CarriedCamera, gives_the_same_for_the_same_seed_only) {
  CarriedCamera a = make(CarryMotion::shake, 3), b = make(CarryMotion::shake, 3),
                c = make(CarryMotion::shake, 4);
  for (int i = 0; i < 2; ++i) {
    const CarriedStep one = a.next(), same = b.next(), other = c.next();
    EXPECT_EQ(one.packet.events, same.packet.events);
    EXPECT_EQ(one.luminance_lux, same.luminance_lux);
    EXPECT_NE(one.packet.events, other.packet.events);
  }
}

TEST(CarriedCamera, refuses_what_is_out_of_range_and_a_model_that_is_not_there) {
  const auto refuses = [](auto change) {
    CameraConfig camera;
    SensorConfig sensor;
    RendererConfig renderer;
    std::filesystem::path model = test::arena();
    double illuminance_lux = 5;
    change(camera, sensor, renderer, model, illuminance_lux);
    EXPECT_THROW(
        CarriedCamera(camera, sensor, renderer, model, illuminance_lux, CarryMotion::hover, 1),
        std::invalid_argument);
  };
  refuses([](auto& camera, auto&, auto&, auto&, auto&) { camera.width_px = 0; });
  refuses([](auto& camera, auto&, auto&, auto&, auto&) { camera.packet_interval_ms = 0; });
  refuses([](auto& camera, auto&, auto&, auto&, auto&) { camera.fovy_deg = std::nan(""); });
  refuses([](auto&, auto&, auto& renderer, auto&, auto&) { renderer.supersampling = 0; });
  refuses([](auto&, auto&, auto& renderer, auto&, auto&) { renderer.max_motion_px = 0; });
  refuses([](auto&, auto& sensor, auto&, auto&, auto&) {
    sensor.preset = SensorPreset::custom;
    sensor.pixel.cutoff_hz = -1;
  });
  refuses([](auto&, auto&, auto&, auto& model, auto&) { model = "no_such.xml"; });
  for (const double lux : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    refuses([lux](auto&, auto&, auto&, auto&, auto& illuminance) { illuminance = lux; });
}

}  // namespace
}  // namespace nightjar::sim
