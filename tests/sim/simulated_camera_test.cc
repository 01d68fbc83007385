#include "sim/simulated_camera.h"

#include <gtest/gtest.h>

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSize{32, 24};

/// A picture that flashes from 1 lux to 5 lux and back, once a millisecond.
void flash(SimulatedCamera& camera, core::Time from, core::Time to) {
  for (core::Time t = from; t < to;) {
    t += 1ms;
    camera.expose(t, core::Image<float>(kSize, t % 2ms == 0us ? 1.f : 5.f));
  }
}

SensorConfig quick() {
  SensorConfig config;
  config.preset = SensorPreset::clean;
  config.aps.exposure_ms = 5;
  config.aps.interval_ms = 10;
  return config;
}

TEST(SimulatedCamera, PacketsFollowEachOtherAndHoldTheirEvents) {
  SimulatedCamera camera(quick(), kSize, 5.0, 1);
  core::Time end{};
  for (int i = 0; i < 4; ++i) {
    flash(camera, end, end + 10ms);
    const core::EventPacket packet = camera.take(end + 10ms).packet;
    EXPECT_EQ(packet.begin, end);
    EXPECT_EQ(packet.end, end + 10ms);
    ASSERT_FALSE(packet.events.empty());
    for (const core::Event& event : packet.events) {
      EXPECT_GT(event.t, packet.begin);
      EXPECT_LE(event.t, packet.end);
    }
    end = packet.end;
  }
}

TEST(SimulatedCamera, EventsAreHandedOverOnce) {
  SimulatedCamera camera(quick(), kSize, 5.0, 1);
  flash(camera, 0ms, 10ms);
  EXPECT_FALSE(camera.take(10ms).packet.events.empty());
  const core::EventPacket again = camera.take(10ms).packet;
  EXPECT_TRUE(again.events.empty());
  EXPECT_EQ(again.begin, 10ms);
  EXPECT_EQ(again.end, 10ms);
}

TEST(SimulatedCamera, FramesAreHandedOverOnce) {
  SimulatedCamera camera(quick(), kSize, 5.0, 1);
  flash(camera, 0ms, 21ms);  // exposures of 5 ms from 1 ms and from 11 ms on
  const std::vector<core::ApsFrame> frames = camera.take(21ms).frames;
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].exposure_begin, 1ms);
  EXPECT_EQ(frames[1].exposure_begin, 11ms);
  EXPECT_TRUE(camera.take(21ms).frames.empty());
}

TEST(SimulatedCamera, WhatIsLaterThanThePacketStaysForTheNext) {
  SimulatedCamera whole(quick(), kSize, 5.0, 1), cut(quick(), kSize, 5.0, 1);
  flash(whole, 0ms, 21ms);
  flash(cut, 0ms, 21ms);  // exposures of 5 ms from 1 ms and from 11 ms on
  const CameraOutput all = whole.take(21ms), first = cut.take(15'500us), rest = cut.take(21ms);
  ASSERT_EQ(first.frames.size(), 1u);
  ASSERT_EQ(rest.frames.size(), 1u);
  EXPECT_EQ(rest.frames[0].exposure_begin, 11ms);
  ASSERT_FALSE(first.packet.events.empty());
  ASSERT_FALSE(rest.packet.events.empty());
  EXPECT_LE(first.packet.events.back().t, 15'500us);
  EXPECT_GT(rest.packet.events.front().t, 15'500us);
  EXPECT_EQ(rest.packet.begin, 15'500us);
  std::vector<core::Event> joined = first.packet.events;
  joined.insert(joined.end(), rest.packet.events.begin(), rest.packet.events.end());
  EXPECT_EQ(joined, all.packet.events);
}

TEST(SimulatedCamera, WhatAFullQueueLosesIsCounted) {
  SensorConfig config = quick();
  config.readout.queue_capacity_events = 8;
  config.readout.max_event_rate_hz = 1e3;
  SimulatedCamera camera(config, kSize, 5.0, 1);
  flash(camera, 0ms, 20ms);
  const std::uint64_t read = camera.take(20ms).packet.events.size();
  const ReadoutCounts& counts = camera.readout_counts();
  EXPECT_EQ(counts.read, read);
  EXPECT_LE(read, 20u);          // one a millisecond
  EXPECT_GT(counts.lost, 100u);  // 768 pixels flash as one, 8 of them may wait
}

}  // namespace
}  // namespace nightjar::sim
