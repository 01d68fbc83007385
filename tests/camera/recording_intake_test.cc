#include "camera/recording_intake.h"

#include <gtest/gtest.h>

#include <limits>

namespace nightjar::camera {
namespace {

using core::Time;

class RecordingIntakeTest : public testing::Test {
 protected:
  RecordingIntakeTest() {
    intake_.set_place([] { return "here"; });
  }
  void event(std::int64_t t_us) { intake_.add(core::Event{Time(t_us), 0, 0, true}, part_); }
  void trigger(std::int64_t t_us) { intake_.add(Trigger{Time(t_us), 2}, part_); }

  RecordingIntake intake_{{4, 4}};
  RecordingPart part_;
};

TEST_F(RecordingIntakeTest, keeps_both_lists_on_one_time_line_over_a_reset) {
  event(5'000'000);
  trigger(4'999'000);
  event(100);          // the reset
  trigger(5'000'100);  // still from before it
  trigger(300);
  event(1'000);
  EXPECT_EQ(part_.events[1].t, Time(5'000'000));
  EXPECT_EQ(part_.triggers[1].t, Time(5'000'100));
  EXPECT_EQ(part_.triggers[2].t, Time(5'000'200));
  EXPECT_EQ(part_.events[2].t, Time(5'000'900));
  EXPECT_EQ(intake_.faults().time_resets, 1u);
}

TEST_F(RecordingIntakeTest, takes_no_time_that_cannot_be) {
  event(-1);
  event(std::numeric_limits<std::int64_t>::min());
  event(std::numeric_limits<std::int64_t>::max());
  event(kMostTime.count());
  EXPECT_EQ(part_.events.size(), 1u);
  EXPECT_EQ(intake_.faults().events_backwards, 3u);
  EXPECT_EQ(intake_.faults().first, "here: time = -1 us, allowed 0 to 999999999999000000 us");
}

TEST_F(RecordingIntakeTest, gives_up_on_a_clock_that_always_begins_anew) {
  for (int i = 0; i < 30'000; ++i) event(i % 2 == 0 ? 2'000'000 : 0);
  EXPECT_EQ(intake_.faults().time_resets, 10'000u);
  EXPECT_GT(intake_.faults().events_backwards, 0u);
}

TEST_F(RecordingIntakeTest, takes_no_inertial_sample_that_is_no_number) {
  RecordedImu sample;
  sample.omega_camera_rad_s.x() = std::numeric_limits<double>::quiet_NaN();
  intake_.add(sample, part_);
  EXPECT_TRUE(part_.imu.empty());
  EXPECT_EQ(intake_.faults().packets_damaged, 1u);
}

}  // namespace
}  // namespace nightjar::camera
