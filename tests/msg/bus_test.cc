#include "msg/bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

core::VehicleState state_at(core::Time t) {
  core::VehicleState state;
  state.t = t;
  return state;
}

core::AttitudeSetpoint setpoint_at(core::Time t) {
  core::AttitudeSetpoint setpoint;
  setpoint.t = t;
  return setpoint;
}

TEST(Bus, HandsOnTheValueThatWasPublished) {
  Bus bus;
  core::EventPacket got;
  bus.subscribe(kEvents, [&](const core::EventPacket& packet) { got = packet; });
  const core::EventPacket sent{5us, 9us, {{6us, 345, 259, true}, {9us, 0, 0, false}}};
  bus.publish(kEvents, sent);
  EXPECT_EQ(bus.dispatch(), 1u);
  EXPECT_EQ(got.begin, sent.begin);
  EXPECT_EQ(got.end, sent.end);
  EXPECT_EQ(got.events, sent.events);
}

TEST(Bus, HandlesNothingBeforeDispatch) {
  Bus bus;
  int calls = 0;
  bus.subscribe(kVehicleState, [&](const core::VehicleState&) { ++calls; });
  bus.publish(kVehicleState, state_at(1us));
  EXPECT_EQ(calls, 0);
  bus.dispatch();
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(bus.dispatch(), 0u);
}

TEST(Bus, DropsNothingOverTenThousandQueuedMessages) {
  constexpr int kMessages = 10'000;  // LCM's default queue holds 30
  Bus bus;
  std::int64_t next_us = 0;
  bool in_order = true;
  bus.subscribe(kVehicleState,
                [&](const core::VehicleState& state) { in_order &= state.t.count() == next_us++; });
  for (int i = 0; i < kMessages; ++i) bus.publish(kVehicleState, state_at(core::Time(i)));
  EXPECT_EQ(bus.dispatch(), static_cast<std::size_t>(kMessages));
  EXPECT_EQ(next_us, kMessages);
  EXPECT_TRUE(in_order);
}

TEST(Bus, KeepsTheOrderOfPublishingAcrossChannels) {
  Bus bus;
  std::vector<std::int64_t> order_us;
  bus.subscribe(kVehicleState,
                [&](const core::VehicleState& s) { order_us.push_back(s.t.count()); });
  bus.subscribe(kAttitudeSetpoint,
                [&](const core::AttitudeSetpoint& s) { order_us.push_back(s.t.count()); });
  bus.publish(kAttitudeSetpoint, setpoint_at(1us));
  bus.publish(kVehicleState, state_at(2us));
  bus.publish(kAttitudeSetpoint, setpoint_at(3us));
  bus.dispatch();
  EXPECT_THAT(order_us, ElementsAre(1, 2, 3));
}

TEST(Bus, HandlesWhatHandlersPublishAfterWhatWaited) {
  Bus bus;
  std::vector<std::int64_t> order_us;
  bus.subscribe(kVehicleState, [&](const core::VehicleState& s) {
    order_us.push_back(s.t.count());
    bus.publish(kAttitudeSetpoint, setpoint_at(s.t + 100us));
  });
  bus.subscribe(kAttitudeSetpoint,
                [&](const core::AttitudeSetpoint& s) { order_us.push_back(s.t.count()); });
  bus.publish(kVehicleState, state_at(1us));
  bus.publish(kVehicleState, state_at(2us));
  EXPECT_EQ(bus.dispatch(), 4u);
  EXPECT_THAT(order_us, ElementsAre(1, 2, 101, 102));
}

TEST(Bus, CallsEverySubscriberInTheOrderOfSubscribing) {
  Bus bus;
  std::string calls;
  for (const char name : {'a', 'b', 'c'})
    bus.subscribe(kVehicleState, [&calls, name](const core::VehicleState&) { calls += name; });
  bus.publish(kVehicleState, state_at(1us));
  EXPECT_EQ(bus.dispatch(), 1u);
  EXPECT_EQ(calls, "abc");
}

TEST(Bus, ForgetsMessagesWithoutASubscriber) {
  Bus bus;
  bus.publish(kVehicleState, state_at(1us));
  bus.subscribe(kVehicleState, [](const core::VehicleState&) { FAIL(); });
  EXPECT_EQ(bus.dispatch(), 0u);
}

TEST(Bus, ThrowsWhatAHandlerThrowsAndGoesOnAfterwards) {
  Bus bus;
  std::vector<std::int64_t> handled_us;
  bus.subscribe(kVehicleState, [&](const core::VehicleState& s) {
    if (s.t == 1us) throw std::domain_error("one is too few");
    handled_us.push_back(s.t.count());
  });
  bus.publish(kVehicleState, state_at(1us));
  bus.publish(kVehicleState, state_at(2us));
  EXPECT_THROW(bus.dispatch(), std::domain_error);
  EXPECT_EQ(bus.dispatch(), 1u);
  EXPECT_THAT(handled_us, ElementsAre(2));
}

TEST(Bus, ShowsAMessageToNoOtherSubscriberOnceAHandlerHasThrown) {
  Bus bus;
  bus.subscribe(kVehicleState, [](const core::VehicleState&) { throw std::domain_error("no"); });
  bus.subscribe(kVehicleState, [](const core::VehicleState&) { FAIL(); });
  bus.publish(kVehicleState, state_at(1us));
  EXPECT_THROW(bus.dispatch(), std::domain_error);
  EXPECT_EQ(bus.dispatch(), 0u);
}

TEST(Bus, ThrowsForAMessageThatDoesNotDecode) {
  Bus bus;
  bus.subscribe(kVehicleState, [](const core::VehicleState&) { FAIL(); });
  bus.publish_bytes(kVehicleState.name, Bytes(40));
  EXPECT_THROW(bus.dispatch(), std::invalid_argument);
}

TEST(Bus, RefusesToDispatchFromAHandler) {
  Bus bus;
  bus.subscribe(kVehicleState, [&](const core::VehicleState&) { bus.dispatch(); });
  bus.publish(kVehicleState, state_at(1us));
  EXPECT_THROW(bus.dispatch(), std::logic_error);
}

TEST(Bus, RefusesChannelNamesThatArePatterns) {
  Bus bus;
  for (const std::string& name :
       {std::string(), std::string("NIGHTJAR_.*"), std::string(64, 'A')}) {
    EXPECT_THROW(bus.subscribe_bytes(name, [](auto) {}), std::invalid_argument);
    EXPECT_THROW(bus.publish_bytes(name, Bytes(8)), std::invalid_argument);
  }
}

TEST(Bus, RefusesAnUrlThatLcmCannotOpen) { EXPECT_THROW(Bus("nosuch://"), std::invalid_argument); }

}  // namespace
}  // namespace nightjar::msg
