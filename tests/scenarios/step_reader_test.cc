#include "scenarios/step_reader.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "msg/event_parts.h"
#include "msg/log_writer.h"
#include "scenarios/recording_steps.h"
#include "tests/support/fake_recording.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

/// What a bus was given: events, states and frames.
struct Listener {
  Listener() {
    bus.subscribe(msg::kEvents, [this](const core::EventPacket& p) { packets.push_back(p); });
    bus.subscribe(msg::kVehicleState, [this](const core::VehicleState&) { ++states; });
    bus.subscribe(msg::kApsFrame, [this](const core::ApsFrame&) { ++frames; });
    bus.subscribe(msg::kPicture, [](const core::Picture&) { FAIL(); });
  }
  /// The packets' ends.
  std::vector<core::Time> read_all(StepReader& steps) {
    std::vector<core::Time> ends;
    for (; const auto t = steps.next(bus); bus.dispatch()) ends.push_back(*t);
    return ends;
  }
  msg::Bus bus;
  std::vector<core::EventPacket> packets;
  int states = 0, frames = 0;
};

core::Event event_at(core::Time t) { return {t, 3, 4, true}; }

core::EventPacket packet_until(core::Time end) {
  return {end - 10ms, end, {event_at(end - 5ms), event_at(end)}};
}

TEST(RecordingSteps, CutsEvery10MillisecondsAndLosesNoEvent) {
  camera::RecordingPart first, second;
  first.events = {event_at(1'000'001us), event_at(1'010'000us), event_at(1'010'001us)};
  second.events = {event_at(1'010'002us), event_at(1'035'000us)};
  second.frames.emplace_back();
  static_cast<core::ApsFrame&>(second.frames.back()) =
      test::flat_frame({4, 4}, 1'012ms, 1'014ms, 7);
  RecordingSteps steps(std::make_unique<test::FakeRecording>(
      core::Resolution{8, 8}, std::vector<camera::RecordingPart>{first, second}));
  EXPECT_FALSE(steps.has_vehicle_states());
  Listener listener;
  EXPECT_EQ(listener.read_all(steps),
            (std::vector<core::Time>{1'010ms, 1'020ms, 1'030ms, 1'040ms}));
  ASSERT_EQ(listener.packets.size(), 4u);
  EXPECT_EQ(listener.packets[0].events.size(), 2u);  // the end of a packet belongs to it
  EXPECT_EQ(listener.packets[1].events.size(), 2u);
  EXPECT_EQ(listener.packets[2].events.size(), 0u);
  EXPECT_EQ(listener.packets[3].events.size(), 1u);
  EXPECT_EQ(listener.frames, 1);
}

TEST(RecordingSteps, RefusesARecordingWithoutEvents) {
  EXPECT_THROW(RecordingSteps(std::make_unique<test::FakeRecording>(
                   core::Resolution{8, 8}, std::vector<camera::RecordingPart>(1))),
               std::invalid_argument);
}

/// A log of two steps as `run` leaves it, or as it was heard on the wire.
void write_log(const std::filesystem::path& path, bool from_the_wire) {
  msg::LogWriter log(path);
  for (const core::Time t : {10ms, 20ms}) {
    core::VehicleState state;
    state.t = t;
    log.write(msg::kVehicleState.name, msg::encode(state));
    const msg::Bytes packet = msg::encode(packet_until(t));
    if (!from_the_wire) log.write(msg::kEvents.name, packet);
    for (const msg::Bytes& part : msg::cut_events(packet, t / 10ms, 1))
      if (from_the_wire) log.write(msg::kEventParts, part);
    log.write(msg::kPicture.name, msg::encode(core::Picture{t, core::Image<std::uint8_t>({2, 2})}));
    msg::StepMark mark;
    mark.t = t;
    if (from_the_wire) log.write(msg::kStep.name, msg::encode(mark));
  }
  log.finish();
}

TEST(LogSteps, SendsWhatTheSourceSaidWhoeverWroteItDown) {
  const test::ScratchFolder scratch;
  for (const bool from_the_wire : {false, true}) {
    write_log(scratch / "run.lcm", from_the_wire);
    const auto steps = open_steps(scratch / "run.lcm");
    EXPECT_TRUE(steps->has_vehicle_states());
    Listener listener;
    EXPECT_EQ(listener.read_all(*steps), (std::vector<core::Time>{10ms, 20ms}));
    EXPECT_EQ(listener.states, 2);
    ASSERT_EQ(listener.packets.size(), 2u);
    EXPECT_EQ(listener.packets[1].events, packet_until(20ms).events);
    EXPECT_EQ(listener.packets[1].begin, 10ms);
  }
}

TEST(LogSteps, RefusesALogWithoutEvents) {
  const test::ScratchFolder scratch;
  msg::LogWriter log(scratch / "run.lcm");
  log.write(msg::kVehicleState.name, msg::encode(core::VehicleState{}));
  log.finish();
  EXPECT_THROW(open_steps(scratch / "run.lcm"), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
