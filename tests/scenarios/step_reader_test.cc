#include "scenarios/step_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

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

TEST(RecordingSteps, HoldsNoMoreThanTheLatestFramesAndSamplesUntilAnEventComes) {
  camera::RecordingPart frames, samples, events;
  frames.frames.resize(1);
  samples.imu.resize(1'000);
  events.events = {event_at(1ms)};
  std::vector<camera::RecordingPart> parts(40, frames);
  for (std::size_t i = 0; i < parts.size(); ++i)
    static_cast<core::ApsFrame&>(parts[i].frames[0]) =
        test::flat_frame({4, 4}, 0us, core::Time(static_cast<int>(i)), 7);
  parts.insert(parts.end(), 150, samples);
  parts.push_back(events);
  RecordingSteps steps(std::make_unique<test::FakeRecording>(core::Resolution{8, 8}, parts));
  Listener listener;
  std::vector<core::Time> frame_ends;
  int samples_heard = 0;
  listener.bus.subscribe(msg::kApsFrame,
                         [&](const core::ApsFrame& f) { frame_ends.push_back(f.exposure_end); });
  listener.bus.subscribe(msg::kImu, [&](const core::ImuSample&) { ++samples_heard; });
  EXPECT_EQ(listener.read_all(steps).size(), 1u);
  ASSERT_EQ(frame_ends.size(), 24u);  // at the 33rd the older half was let go, so ...
  EXPECT_EQ(frame_ends.front(), 16us);
  EXPECT_EQ(samples_heard, 99'500);  // ... at the 101,000th
  EXPECT_EQ(steps.faults(), "left out 50516 frames and IMU samples of a time without events");
}

TEST(RecordingSteps, SaysWhatWasWrongWithTheRecording) {
  camera::RecordingPart part;
  part.events = {event_at(1ms)};
  auto recording = std::make_unique<test::FakeRecording>(core::Resolution{8, 8},
                                                         std::vector<camera::RecordingPart>{part});
  recording->faults_.bytes_lost = 3;
  recording->faults_.first = "a.rec: byte 7";
  EXPECT_EQ(RecordingSteps(std::move(recording)).faults(), "3 bytes lost; first: a.rec: byte 7");
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

TEST(LogSteps, PassesOverEventsThatDoNotDecodeAndCountsThem) {
  const test::ScratchFolder scratch;
  const auto write = [&](bool whole) {
    msg::LogWriter log(scratch / "run.lcm");
    log.write(msg::kEvents.name, msg::encode(packet_until(10ms)));
    msg::Bytes reversed = msg::encode(packet_until(20ms));
    std::rotate(reversed.end() - 16, reversed.end() - 8, reversed.end());
    for (const msg::Bytes& bytes : {msg::Bytes(16), msg::Bytes(40), reversed})
      if (!whole) log.write(msg::kEvents.name, bytes);
    for (const msg::Bytes& piece : msg::cut_events(msg::encode(packet_until(30ms)), 3, 1)) {
      if (!whole) log.write(msg::kEventParts, msg::Bytes(piece.begin(), piece.end() - 1));
      log.write(msg::kEventParts, piece);
    }
    log.write(msg::kStep.name, msg::encode(msg::StepMark{}));
    log.finish();
  };
  for (const bool whole : {true, false}) {
    write(whole);
    const auto steps = open_steps(scratch / "run.lcm");
    Listener listener;
    EXPECT_EQ(listener.read_all(*steps), (std::vector<core::Time>{10ms, 30ms}));
    ASSERT_EQ(listener.packets.size(), 2u);
    EXPECT_EQ(listener.packets[1].events, packet_until(30ms).events);
    const std::string faults = steps->faults();
    if (whole)
      EXPECT_EQ(faults, "");
    else
      EXPECT_TRUE(faults.starts_with("5 damaged packets; first: " + (scratch / "run.lcm").string() +
                                     ": byte 87: message: event_packet_t"))
          << faults;
  }
}

TEST(LogSteps, HoldsNoMoreThanTenThousandMessagesUntilEventsCome) {
  const test::ScratchFolder scratch;
  for (const bool in_pieces : {false, true}) {
    msg::LogWriter log(scratch / "run.lcm");
    const msg::Bytes packet = msg::encode(core::EventPacket{0ms, 10ms, {}});
    for (int i = 0; i < 10'001; ++i) {
      core::VehicleState state;
      state.t = core::Time(i);
      if (in_pieces)
        log.write(msg::kEventParts, msg::cut_events(packet, i, 1).at(0));
      else
        log.write(msg::kVehicleState.name, msg::encode(state));
    }
    if (!in_pieces) log.write(msg::kEvents.name, packet);
    log.write(msg::kStep.name, msg::encode(msg::StepMark{}));
    log.finish();
    const auto steps = open_steps(scratch / "run.lcm");
    Listener listener;
    EXPECT_EQ(listener.read_all(*steps).size(), 1u);
    EXPECT_EQ(listener.states, in_pieces ? 0 : 1);
    EXPECT_EQ(listener.packets.size(), 1u);
    EXPECT_TRUE(steps->faults().starts_with("10000 damaged packets; first: "));
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
