#include "camera/caer_packets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/camera_caer_double.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;

class CaerPacketsTest : public testing::Test {
 protected:
  CaerPacketsTest() {
    intake_.set_place([] { return std::string("camera: container 3"); });
  }

  void decode(const std::string& packet) {
    decode_caer_packet(std::as_bytes(std::span(packet)), intake_, part_);
  }

  RecordingIntake intake_{{346, 260}};
  RecordingPart part_;
};

TEST_F(CaerPacketsTest, reads_events_in_the_places_of_their_bits) {
  decode(test::caer_packet(
      1, 8, 0, 2, test::caer_polarity(345, 3, true, 5) + test::caer_polarity(1, 259, false, 6)));
  EXPECT_THAT(part_.events,
              ElementsAre(Event{Time(5), 345, 3, true}, Event{Time(6), 1, 259, false}));
}

TEST_F(CaerPacketsTest, makes_times_of_64_bits_from_the_count_of_wraps) {
  decode(test::caer_events_at(0, {0x7fffffff}));
  decode(test::caer_events_at(1, {0}));
  decode(test::caer_events_at(1000, {17}));
  EXPECT_EQ(part_.events[0].t, Time(2147483647));
  EXPECT_EQ(part_.events[1].t, Time(2147483648));
  EXPECT_EQ(part_.events[2].t, Time(2147483648000 + 17));
}

TEST_F(CaerPacketsTest, reads_frames_imu_samples_and_triggers) {
  decode(test::caer_packet(2, 36 + 4, 0, 1, test::caer_frame(100, 4100, {0xffc0, 0x0040})));
  decode(test::caer_packet(3, 36, 0, 1, test::caer_imu6(4000)));
  decode(test::caer_packet(0, 8, 0, 2, test::caer_special(2, 50) + test::caer_special(0, 60)));
  ASSERT_EQ(part_.frames.size(), 1u);
  EXPECT_EQ(part_.frames[0].bits, 10);
  EXPECT_THAT(part_.frames[0].gray.pixels(), ElementsAre(1023, 1));
  EXPECT_EQ(part_.frames[0].exposure_end, Time(4100));
  ASSERT_EQ(part_.imu.size(), 1u);
  // The chip's y is the camera's, and an accelerometer at rest reads y = -1 g.
  EXPECT_NEAR(part_.imu[0].specific_force_camera_m_s2.y(), -9.80665, 1e-6);  // float
  EXPECT_THAT(part_.triggers, ElementsAre(Trigger{Time(50), 2}));            // a wrap is none
  EXPECT_FALSE(intake_.faults().any());
}

TEST_F(CaerPacketsTest, takes_no_time_from_a_reset_that_has_none) {
  decode(test::caer_events_at(0, {300}));
  decode(test::caer_packet(0, 8, 0, 1, test::caer_special(1, 0x7fffffff)));
  decode(test::caer_events_at(0, {10, 15}));
  EXPECT_EQ(part_.events[1].t, Time(300));
  EXPECT_EQ(part_.events[2].t, Time(305));
  EXPECT_TRUE(part_.triggers.empty());
  EXPECT_EQ(intake_.faults().time_resets, 1u);
}

TEST_F(CaerPacketsTest, passes_over_what_a_filter_marked_invalid) {
  std::string event = test::caer_polarity(1, 1, true, 7);
  event[0] = static_cast<char>(event[0] & ~1);
  decode(test::caer_packet(1, 8, 0, 1, event));
  EXPECT_TRUE(part_.events.empty());
  EXPECT_FALSE(intake_.faults().any());
}

TEST_F(CaerPacketsTest, leaves_alone_a_packet_that_holds_less_than_it_says) {
  const std::string whole = test::caer_events_at(0, {5, 6});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto bytes = std::make_unique<std::byte[]>(size);  // sanitizers guard its end
    std::copy_n(reinterpret_cast<const std::byte*>(whole.data()), size, bytes.get());
    decode_caer_packet({bytes.get(), size}, intake_, part_);
    EXPECT_EQ(intake_.faults().packets_damaged, size + 1);
  }
  EXPECT_TRUE(part_.events.empty());
  EXPECT_THAT(intake_.faults().first, HasSubstr("camera: container 3: of 0 bytes"));
}

TEST_F(CaerPacketsTest, counts_packets_whose_numbers_cannot_be) {
  for (const auto& [size, overflow, number] :
       {std::tuple{-8, 0, 1}, {8, -1, 1}, {8, 0, -1}, {0, 0, 0}, {4, 0, 1}, {1 << 30, 0, 1 << 30}})
    decode(test::caer_packet(1, size, overflow, number, std::string(8, '\1')));
  EXPECT_EQ(intake_.faults().packets_damaged, 6u);
  decode(test::caer_packet(4, 8, 0, 1, std::string(8, '\1')));  // IMU9: no DAVIS346 sends it
  EXPECT_EQ(intake_.faults().packets_unknown, 1u);
  EXPECT_TRUE(part_.events.empty());
}

}  // namespace
}  // namespace nightjar::camera
