#include "scenarios/event_stream.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "tests/support/fake_recording.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

camera::RecordingPart part(std::initializer_list<core::Time> times) {
  camera::RecordingPart part;
  for (const core::Time t : times) part.events.push_back({t, 0, 0, true});
  return part;
}

TEST(EventStream, gives_each_event_once_up_to_and_including_the_time_asked_for) {
  test::FakeRecording recording({1, 1}, {part({}), part({1ms, 2ms}), part({}), part({3ms, 9ms})});
  EventStream stream(recording);
  EXPECT_EQ(stream.next_time(), 1ms);
  EXPECT_TRUE(stream.take_until(999us).empty());
  std::vector<core::Time> times;
  for (auto events = stream.take_until(3ms); !events.empty(); events = stream.take_until(3ms))
    for (const core::Event& e : events) times.push_back(e.t);
  EXPECT_EQ(times, (std::vector<core::Time>{1ms, 2ms, 3ms}));
  EXPECT_EQ(stream.next_time(), 9ms);
  EXPECT_EQ(stream.take_until(1s).size(), 1u);
  EXPECT_FALSE(stream.next_time());
  EXPECT_TRUE(stream.take_until(2s).empty());
}

TEST(EventStream, tells_how_long_the_recording_seems_to_be) {
  test::FakeRecording recording({1, 1}, {part({1s, 2s}), part({2s, 9s})});
  EventStream stream(recording);
  stream.take_until(1s);
  EXPECT_DOUBLE_EQ(stream.estimated_duration_s(), 2);  // half is read, which takes 1 s
  stream.take_until(2s);
  stream.take_until(2s);
  EXPECT_DOUBLE_EQ(stream.estimated_duration_s(), 8);
}

}  // namespace
}  // namespace nightjar::scenarios
