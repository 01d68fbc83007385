#include "scenarios/reconstruction_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "msg/channels.h"
#include "tests/support/fake_recording.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_network.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{12, 9};

/// The pictures a node makes of one packet and the frames before it.
std::vector<core::Picture> pictures(const esi::ReconstructorConfig& config,
                                    const std::vector<core::ApsFrame>& frames) {
  msg::Bus bus;
  ReconstructionNode node(bus, config, kSensor);
  std::vector<core::Picture> pictures;
  bus.subscribe(msg::kPicture, [&](const core::Picture& picture) { pictures.push_back(picture); });
  for (const core::ApsFrame& frame : frames) bus.publish(msg::kApsFrame, frame);
  bus.publish(msg::kEvents, {.begin = 0ms, .end = 10ms, .events = {{4ms, 3, 4, true}}});
  bus.publish(msg::kEvents, {.begin = 10ms, .end = 20ms, .events = {}});
  bus.dispatch();
  return pictures;
}

TEST(ReconstructionNodeTest, shows_the_same_whenever_the_cameras_clock_began) {
  std::vector<core::Picture> made;
  for (const core::Time ahead : {core::Time(0), core::Time(1h)}) {
    msg::Bus bus;
    ReconstructionNode node(bus, {}, kSensor);
    bus.subscribe(msg::kPicture, [&](const core::Picture& picture) { made.push_back(picture); });
    bus.publish(msg::kEvents, {ahead, ahead + 10ms, {{ahead + 4ms, 3, 4, true}}});
    bus.dispatch();
  }
  ASSERT_EQ(made.size(), 2u);
  EXPECT_EQ(made[1].t, 1h + 10ms);
  EXPECT_TRUE(std::ranges::equal(made[0].gray.pixels(), made[1].gray.pixels()));
}

TEST(ReconstructionNodeTest, makes_a_picture_at_the_end_of_every_packet) {
  const auto made = pictures({}, {});
  ASSERT_EQ(made.size(), 2u);
  EXPECT_EQ(made[0].t, 10ms);
  EXPECT_EQ(made[1].t, 20ms);
  EXPECT_GT(made[0].gray(3, 4), made[0].gray(0, 0));
}

TEST(ReconstructionNodeTest, hands_frames_to_the_method_with_the_packet_they_end_in) {
  esi::ReconstructorConfig config;
  config.method = esi::Method::complementary_filter;
  config.complementary_filter.cutoff_hz = 50;
  const auto without = pictures(config, {});
  const auto now = pictures(config, {test::flat_frame(kSensor, 1ms, 2ms, 200)});
  const auto later = pictures(config, {test::flat_frame(kSensor, 1ms, 12ms, 200)});
  EXPECT_NE(now[0].gray, without[0].gray);
  EXPECT_EQ(later[0].gray, without[0].gray);
  EXPECT_NE(later[1].gray, without[1].gray);
}

TEST(ReconstructionNodeTest, flies_networks_too) {
  const test::ScratchFolder folder;
  esi::ReconstructorConfig config;
  config.method = esi::Method::firenet;
  EXPECT_THROW(pictures(config, {}), std::invalid_argument);
  const test::TinyNetwork network{.size = kSensor};
  config.firenet = {.weights = network.write(folder / "tiny.onnx").string(),
                    .normalise = false,
                    .stretch = false};
  EXPECT_EQ(pictures(config, {})[1].gray(3, 4), 64);  // a quarter of 255
}

}  // namespace
}  // namespace nightjar::scenarios
