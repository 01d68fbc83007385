#include "scenarios/node_process.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "msg/channels.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

core::Picture picture_at(core::Time t) { return {t, core::Image<std::uint8_t>({2, 2})}; }

core::VehicleState state_at(core::Time t) {
  core::VehicleState state;
  state.t = t;
  return state;
}

msg::StepMark mark_at(core::Time t, bool lock_step, std::int64_t run = 1) {
  msg::StepMark mark;
  mark.t = t;
  mark.run = run;
  mark.lock_step = lock_step;
  return mark;
}

/// Answers each picture with a setpoint that tells how many states it had by then.
struct CountingNode {
  explicit CountingNode(msg::Bus& bus) {
    bus.subscribe(msg::kVehicleState, [this](const core::VehicleState&) { ++states; });
    bus.subscribe(msg::kPicture, [this, &bus](const core::Picture& picture) {
      if (states == 0) throw std::invalid_argument("no state yet");
      core::AttitudeSetpoint setpoint;
      setpoint.t = picture.t;
      setpoint.thrust_m_s2 = states;
      bus.publish(msg::kAttitudeSetpoint, setpoint);
    });
  }
  int states = 0;
};

class NodeProcessTest : public testing::Test {
 protected:
  NodeProcessTest() {
    wire_.subscribe(msg::kAttitudeSetpoint, [this](const core::AttitudeSetpoint& setpoint) {
      answers_.push_back({setpoint.t, setpoint.thrust_m_s2});
    });
  }

  void send_state(core::Time t, bool lock_step, std::int64_t run = 1) {
    source_.add(msg::kVehicleState.name, msg::encode(state_at(t)));
    source_.send(mark_at(t, lock_step, run));
  }
  void send_picture(core::Time t, bool lock_step, std::int64_t run = 1) {
    reconstruction_.add(msg::kPicture.name, msg::encode(picture_at(t)));
    reconstruction_.send(mark_at(t, lock_step, run));
  }

  /// What has been answered since the last call: time and number of states.
  std::vector<std::pair<core::Time, double>> answers() {
    process_.serve(0ms);
    wire_.dispatch();
    return std::exchange(answers_, {});
  }
  using Answers = std::vector<std::pair<core::Time, double>>;

  msg::Bus wire_;
  msg::StepSender source_{wire_, kSource}, reconstruction_{wire_, kReconstruction};
  NodeProcess process_{
      wire_,
      {.inputs = {{kSource, {msg::kVehicleState.name}}, kFromReconstruction},
       .output = kFromTracker,
       .make_node = [](msg::Bus& bus) { return std::make_shared<CountingNode>(bus); }}};
  Answers answers_;
};

TEST_F(NodeProcessTest, AnswersWithItsNodesMessages) {
  for (const bool lock_step : {false, true}) {
    send_state(10ms, lock_step, lock_step);
    send_picture(10ms, lock_step, lock_step);
    EXPECT_EQ(answers(), (Answers{{10ms, 1}}));
  }
  EXPECT_EQ(process_.meter().report().steps, 2u);
}

TEST_F(NodeProcessTest, InLockStepWaitsForAllInputsOfTheStepInWhicheverOrder) {
  send_state(10ms, true);
  send_picture(10ms, true);
  answers();
  send_picture(20ms, true);
  EXPECT_EQ(answers(), Answers{});
  send_state(20ms, true);
  EXPECT_EQ(answers(), (Answers{{20ms, 2}}));
}

TEST_F(NodeProcessTest, InLockStepARepeatedStepRepeatsTheAnswerAndNothingElse) {
  send_state(10ms, true);
  send_picture(10ms, true);
  answers();
  source_.repeat();
  EXPECT_EQ(answers(), Answers{});
  reconstruction_.repeat();
  EXPECT_EQ(answers(), (Answers{{10ms, 1}}));
  send_state(20ms, true);
  send_picture(20ms, true);
  EXPECT_EQ(answers(), (Answers{{20ms, 2}}));
  EXPECT_EQ(process_.meter().report().steps_repeated, 1u);
}

TEST_F(NodeProcessTest, ASourceThatBeginsAnewMeetsANewNode) {
  send_state(50ms, true, 1);
  send_picture(50ms, true, 1);
  answers();
  send_state(10ms, true, 2);
  send_picture(60ms, true, 1);  // of the run that is over
  EXPECT_EQ(answers(), Answers{});
  send_picture(10ms, true, 2);
  EXPECT_EQ(answers(), (Answers{{10ms, 1}}));
}

TEST_F(NodeProcessTest, CountsWhatItsNodeOrTheWireCannotUseAndGoesOn) {
  source_.send(mark_at(10ms, false));
  send_picture(10ms, false);
  wire_.publish_bytes(msg::kStep.name, msg::Bytes(40));
  EXPECT_EQ(answers(), Answers{});
  EXPECT_EQ(process_.meter().report().refused, 2u);
  send_state(20ms, false);
  send_picture(20ms, false);
  EXPECT_EQ(answers(), (Answers{{20ms, 1}}));
}

TEST_F(NodeProcessTest, FreeRunningSaysNothingOfItsOwnAccord) {
  send_state(10ms, false);
  send_picture(10ms, false);
  EXPECT_EQ(answers(), (Answers{{10ms, 1}}));
  for (core::Time t = 20ms; t <= 1000ms; t += 10ms) send_state(t, false);  // no pictures
  EXPECT_EQ(answers(), Answers{});
}

TEST_F(NodeProcessTest, FreeRunningAnswersTheLatestWhenFarBehind) {
  for (core::Time t = 10ms; t <= 200ms; t += 10ms) {
    send_state(t, false);
    send_picture(t, false);
  }
  const Answers latest = answers();
  EXPECT_EQ(latest.size(), 5u);
  EXPECT_EQ(latest.back(), (std::pair<core::Time, double>(200ms, 20)));  // no state left out
  EXPECT_EQ(process_.meter().report().steps_dropped, 20u - 5u);
}

}  // namespace
}  // namespace nightjar::scenarios
