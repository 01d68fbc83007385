#include "scenarios/send_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <utility>

#include "msg/channels.h"
#include "msg/step_receiver.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using camera::Arrival;
using testing::ElementsAre;

/// Says what it was told to, then that it is over.
class ScriptedCamera : public camera::EventSource {
 public:
  std::string name() const override { return "scripted"; }
  core::Resolution size() const override { return {8, 8}; }
  void start() override { started = true; }
  void stop() override {}
  camera::SourceCounts counts() const override { return counts_; }
  Arrival next(camera::LivePacket& packet) override {
    packet = {};
    if (script.empty()) return Arrival::end;
    auto [arrival, next] = std::move(script.front());
    script.pop_front();
    packet = std::move(next);
    if (arrival == Arrival::packet) ++counts_.packets;
    if (arrival == Arrival::disconnected) ++counts_.disconnects;
    return arrival;
  }

  std::deque<std::pair<Arrival, camera::LivePacket>> script;
  bool started = false;

 private:
  camera::SourceCounts counts_;
};

camera::LivePacket packet_between(core::Time begin, core::Time end) {
  camera::LivePacket packet;
  packet.begin = begin;
  packet.end = end;
  packet.events = {{end, 3, 4, true}};
  return packet;
}

/// What is heard on the wire.
class SendCameraTest : public testing::Test {
 protected:
  SendCameraTest() {
    for (const char* channel : {msg::kSensor.name, msg::kTrigger.name, msg::kImu.name,
                                msg::kApsFrame.name, msg::kEventParts})
      wire_.subscribe_bytes(channel, [this, channel](auto) { heard_.emplace_back(channel); });
    wire_.subscribe(msg::kSensor, [this](const msg::SensorNote& note) { sensor_ = note; });
    wire_.subscribe(msg::kTrigger, [this](const msg::TriggerNote& note) { trigger_ = note; });
    wire_.subscribe(msg::kStep, [this](const msg::StepMark& mark) { marks_.push_back(mark); });
  }

  void send() {
    SourceLink link(wire_, std::nullopt,
                    {.lock_step = false, .while_waiting = [this] { ++idle_; }});
    send_camera(camera_, link);
    report_ = link.meter().report();
    wire_.dispatch();
  }

  msg::Bus wire_;
  ScriptedCamera camera_;
  std::vector<std::string> heard_;
  msg::SensorNote sensor_;
  msg::TriggerNote trigger_;
  std::vector<msg::StepMark> marks_;
  int idle_ = 0;
  ProcessReport report_;
};

TEST_F(SendCameraTest, EventsCloseAPacketAndTheMarkTellsWhenItArrived) {
  camera::LivePacket packet = packet_between(10ms, 20ms);
  packet.triggers = {{11ms, 2}};
  packet.imu.emplace_back().t = 15ms;
  camera::RecordedFrame& frame = packet.frames.emplace_back();
  frame.exposure_end = 12ms;
  frame.bits = 10;
  frame.gray = core::Image<std::uint16_t>({8, 8});
  const auto arrived = std::chrono::steady_clock::now();
  packet.received = arrived;
  camera_.script.emplace_back(Arrival::packet, std::move(packet));
  send();
  EXPECT_TRUE(camera_.started);
  EXPECT_THAT(heard_, ElementsAre(msg::kSensor.name, msg::kTrigger.name, msg::kImu.name,
                                  msg::kApsFrame.name, msg::kEventParts));
  EXPECT_EQ(trigger_, (msg::TriggerNote{11ms, 2}));
  ASSERT_EQ(marks_.size(), 1u);
  EXPECT_EQ(marks_[0].t, 20ms);
  EXPECT_FALSE(marks_[0].lock_step);
  EXPECT_EQ(marks_[0].origin, std::chrono::duration_cast<core::Time>(arrived.time_since_epoch()));
  EXPECT_EQ(report_.latency.count(), 1u);  // of the sending, for nobody answers
}

TEST_F(SendCameraTest, TheFirstPacketBeginsWithTheSensorSoThatALogOfTheWireKnowsItsSize) {
  camera_.script.emplace_back(Arrival::packet, packet_between(10ms, 20ms));
  camera_.script.emplace_back(Arrival::packet, packet_between(20ms, 30ms));
  send();
  EXPECT_THAT(heard_, ElementsAre(msg::kSensor.name, msg::kEventParts, msg::kEventParts));
  EXPECT_EQ(sensor_, (msg::SensorNote{10ms, {8, 8}, "scripted"}));
}

TEST_F(SendCameraTest, WhoDoesNotListenToTriggersMissesNothingOfAStep) {
  msg::StepReceiver reconstruction(wire_, kSource, {msg::kApsFrame.name, msg::kEvents.name});
  camera::LivePacket first = packet_between(0ms, 10ms);
  first.triggers = {{5ms, 2}, {6ms, 2}};
  camera_.script.emplace_back(Arrival::packet, std::move(first));
  camera_.script.emplace_back(Arrival::packet, packet_between(10ms, 20ms));
  send();
  for (int i = 0; i < 2; ++i) {
    const auto step = reconstruction.next();
    ASSERT_TRUE(step);
    ASSERT_EQ(step->messages.size(), 1u);
    EXPECT_EQ(step->messages[0].channel, msg::kEvents.name);
  }
  EXPECT_EQ(reconstruction.counts().messages_lost, 0u);
  EXPECT_EQ(reconstruction.counts().steps_lost, 0u);
}

TEST_F(SendCameraTest, ASilentCameraLetsTheOthersReportAndStop) {
  camera_.script.emplace_back(Arrival::silent, camera::LivePacket());
  camera_.script.emplace_back(Arrival::disconnected, camera::LivePacket());
  send();
  EXPECT_GE(idle_, 2);
  EXPECT_TRUE(marks_.empty());
  ASSERT_TRUE(report_.camera);
  EXPECT_EQ(report_.camera->name, "scripted");
  EXPECT_FALSE(report_.camera->connected);
}

TEST_F(SendCameraTest, ACameraThatWasAwayForHoursGoesOn) {
  camera_.script.emplace_back(Arrival::packet, packet_between(0ms, 10ms));
  camera_.script.emplace_back(Arrival::packet, packet_between(10ms, 3h));
  send();
  ASSERT_EQ(marks_.size(), 2u);
  EXPECT_EQ(marks_[1].t, 3h);
}

}  // namespace
}  // namespace nightjar::scenarios
