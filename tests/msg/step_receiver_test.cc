#include "msg/step_receiver.h"

#include <gtest/gtest.h>

#include "msg/step_sender.h"

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;

const std::string kStates = kVehicleState.name;

core::VehicleState state_at(core::Time t) {
  core::VehicleState state;
  state.t = t;
  return state;
}

/// 12,000 events are two pieces.
core::EventPacket packet_at(core::Time t) {
  return {t - 10ms, t, std::vector<core::Event>(12'000, {t, 1, 2, true})};
}

/// A sender and a receiver with a wire between them that loses messages by number.
class StepsTest : public testing::Test {
 protected:
  StepsTest() {
    for (const std::string& channel : {kStates, std::string(kEventParts), std::string(kStep.name)})
      from_.subscribe_bytes(channel, [this, channel](std::span<const std::uint8_t> bytes) {
        if (carried_++ != lost_) to_.publish_bytes(channel, bytes);
      });
  }

  /// A state and its two pieces of events, then the mark: messages 0 to 3.
  void send(core::Time t, bool lock_step, std::int64_t run = 1) {
    sender_.add(kStates, encode(state_at(t)));
    sender_.add(kEvents.name, encode(packet_at(t)));
    StepMark mark;
    mark.t = t;
    mark.run = run;
    mark.lock_step = lock_step;
    sender_.send(mark);
    carry();
  }

  void carry(int lost = -1) {
    carried_ = 0;
    if (lost >= 0) lost_ = lost;
    from_.dispatch();
    to_.dispatch();
    lost_ = -1;
  }

  void expect_whole(const ReceivedStep& step, core::Time t) {
    EXPECT_EQ(step.mark.t, t);
    EXPECT_EQ(step.messages, (std::vector<Message>{{kStates, encode(state_at(t))},
                                                   {kEvents.name, encode(packet_at(t))}}));
  }

  Bus from_, to_;
  int carried_ = 0, lost_ = -1;
  StepSender sender_{from_, "source"};
  StepReceiver receiver_{to_, "source", {kStates, kEvents.name}};
};

TEST_F(StepsTest, AStepArrivesAsItWasSent) {
  for (const bool lock_step : {true, false}) {
    send(10ms, lock_step);
    const auto step = receiver_.next();
    ASSERT_TRUE(step);
    expect_whole(*step, 10ms);
    EXPECT_FALSE(receiver_.next());
  }
  EXPECT_EQ(receiver_.counts().messages_lost, 0u);
}

TEST_F(StepsTest, InLockStepWhicheverMessageIsLostTheStepComesWholeInTheEnd) {
  for (int lost = 0; lost < 4; ++lost) {
    const core::Time t = 10ms * (lost + 1);
    lost_ = lost;
    send(t, true);
    EXPECT_FALSE(receiver_.next()) << lost;
    int repeats = 0;
    std::optional<ReceivedStep> step;
    for (; !step && repeats < 3; ++repeats) {
      sender_.repeat();
      carry();
      step = receiver_.next();
    }
    ASSERT_TRUE(step) << lost;
    expect_whole(*step, t);
    // With the mark itself the end of the first sending is lost: one more is thrown away.
    EXPECT_EQ(repeats, lost == 3 ? 2 : 1);
  }
}

TEST_F(StepsTest, FreeRunningALostMessageIsCountedAndTheRestHandedOut) {
  send(10ms, false);
  receiver_.next();
  lost_ = 2;
  send(20ms, false);
  const auto step = receiver_.next();
  ASSERT_TRUE(step);
  ASSERT_EQ(step->messages.size(), 2u);
  EXPECT_EQ(decode<core::EventPacket>(step->messages[1].bytes).events.size(), 8000u);
  EXPECT_EQ(receiver_.counts().messages_lost, 1u);
  EXPECT_EQ(receiver_.counts().steps_lost, 0u);
}

TEST_F(StepsTest, FreeRunningALostMarkIsCountedAndItsMessagesComeWithTheNext) {
  send(10ms, false);
  receiver_.next();
  lost_ = 3;
  send(20ms, false);
  EXPECT_FALSE(receiver_.next());
  send(30ms, false);
  const auto step = receiver_.next();
  ASSERT_TRUE(step);
  EXPECT_EQ(step->messages.size(), 4u);
  EXPECT_EQ(receiver_.counts().steps_lost, 1u);
  EXPECT_EQ(receiver_.counts().messages_lost, 0u);
}

TEST_F(StepsTest, WhatWasSentOfAnotherRunBeforeItsFirstStepCameIsNoGap) {
  send(10ms, false, 1);
  for (const core::Time t : {10ms, 20ms}) {
    lost_ = 3;  // the mark
    send(t, false, 2);
  }
  send(30ms, false, 2);
  EXPECT_EQ(receiver_.next()->mark.sequence, 0);
  EXPECT_EQ(receiver_.next()->mark.sequence, 2);
  EXPECT_EQ(receiver_.counts().steps_lost, 0u);
}

TEST_F(StepsTest, FreeRunningTheOldestStepsCanBeLeftOutInLockStepNever) {
  for (const bool lock_step : {false, true}) {
    for (core::Time t = 10ms; t <= 40ms; t += 10ms) send(t, lock_step);
    EXPECT_EQ(receiver_.drop_all_but(1), lock_step ? 0u : 3u);
    EXPECT_EQ(receiver_.next()->mark.t, lock_step ? 10ms : 40ms);
    while (receiver_.next()) continue;
  }
}

TEST_F(StepsTest, WhatOtherSendersCloseIsNotTaken) {
  to_.publish(kVehicleState, state_at(10ms));
  StepMark mark;
  mark.sender = "tracker";
  to_.publish(kStep, mark);
  to_.dispatch();
  EXPECT_FALSE(receiver_.next());
}

}  // namespace
}  // namespace nightjar::msg
