#include "scenarios/reconstructor_feed.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/fake_recording.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{4, 4};

/// Writes down what it is handed: "e3" for an event at 3 ms, "f2" for a frame that ends there.
class Diary : public esi::Reconstructor {
 public:
  Diary() : Reconstructor(kSensor) { reset(); }
  std::string text;

 private:
  void integrate(std::span<const esi::PackedEvent> events) override {
    for (const auto& e : events) text.append("e").append(std::to_string(e.t_us / 1000)).append(" ");
  }
  void take_frame(core::ApsFrame&& frame) override {
    text.append("f").append(std::to_string(frame.exposure_end / 1ms)).append(" ");
  }
  void draw(core::Time, core::Image<std::uint8_t>&) override {}
  void clear(core::Time) override {}
  void limit_ages(std::uint32_t, std::uint32_t) override {}
};

core::ApsFrame frame(core::Time begin, core::Time end) {
  return test::flat_frame(kSensor, begin, end, 9);
}

std::vector<core::Event> events(std::initializer_list<core::Time> times) {
  std::vector<core::Event> out;
  for (const core::Time t : times) out.push_back({t, 0, 0, true});
  return out;
}

TEST(ReconstructorFeedTest, hands_a_frame_over_after_the_events_of_its_exposure) {
  Diary diary;
  ReconstructorFeed feed(diary);
  feed.add_frame(frame(1ms, 3ms));
  feed.add_frame(frame(4ms, 9ms));  // ends later than anything known
  feed.advance(events({2ms, 3ms, 4ms}), 5ms);
  EXPECT_EQ(diary.text, "e2 e3 f3 e4 ");
  feed.advance(events({8ms}), 10ms);
  EXPECT_EQ(diary.text, "e2 e3 f3 e4 e8 f9 ");
  EXPECT_EQ(feed.frames(), 2u);
}

TEST(ReconstructorFeedTest, hands_a_frame_that_comes_late_over_at_once) {
  Diary diary;
  ReconstructorFeed feed(diary);
  feed.advance(events({7ms}), 8ms);
  feed.add_frame(frame(1ms, 3ms));
  feed.advance(events({9ms}), 9ms);
  EXPECT_EQ(diary.text, "e7 f3 e9 ");
}

TEST(ReconstructorFeedTest, drops_and_counts_what_is_refused) {
  Diary diary;
  ReconstructorFeed feed(diary);
  feed.add_frame(frame(3ms, 2ms));
  feed.add_frame(test::flat_frame({4, 5}, 3ms, 4ms, 9));
  feed.add_frame(frame(4ms, 5ms));
  feed.advance({}, 9ms);
  EXPECT_EQ(diary.text, "f5 ");
  EXPECT_EQ(feed.frames(), 1u);
  EXPECT_EQ(feed.frames_refused(), 2u);
  EXPECT_NE(feed.first_refusal().find("from 3000 to 2000 us"), std::string::npos);
}

}  // namespace
}  // namespace nightjar::scenarios
