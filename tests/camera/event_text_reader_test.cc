#include "camera/event_text_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/support/data_folder.h"
#include "tests/support/recordings.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(EventTextRecordingTest, finds_the_smallest_sensor_unless_it_is_told) {
  const std::string text = "# t x y p\n0.1 3 9 1\n0.2 239 0 0\n";
  const test::WholeRecording read = test::read_bytes(text);
  EXPECT_EQ(read.format, "text");
  EXPECT_EQ(read.size, (core::Resolution{240, 10}));
  EXPECT_EQ(read.all.events.size(), 2u);
  EXPECT_EQ(test::read_bytes(text, core::Resolution{346, 260}).size, (core::Resolution{346, 260}));
  EXPECT_EQ(test::read_bytes("").size, (core::Resolution{1, 1}));
}

TEST(EventTextRecordingTest, drops_and_counts_what_is_off_the_sensor_or_late) {
  const test::WholeRecording read =
      test::read_bytes("0.1 3 0 1\n0.2 4 0 1\n0.1 1 1 1\n", core::Resolution{4, 4});
  EXPECT_THAT(read.all.events,
              ElementsAre(Event{Time(100000), 3, 0, true}, Event{Time(100000), 1, 1, true}));
  EXPECT_EQ(read.faults.events_outside, 1u);
  EXPECT_THAT(read.faults.first, HasSubstr("dark.rec:2: "));
}

TEST(EventTextRecordingTest, takes_a_cut_last_line_for_the_end_of_a_truncated_file) {
  const std::string text = "0.1 3 0 1\n0.25 4";
  EXPECT_EQ(test::read_bytes(text).all.events.size(), 1u);
  EXPECT_EQ(test::read_bytes(text, core::Resolution{9, 9}).faults.bytes_lost, 6u);
}

TEST(EventTextRecordingTest, refuses_any_other_line_that_is_no_event) {
  EXPECT_THAT([] { test::read_bytes("0.1 3 0 1\nwords\n"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("dark.rec:2: ")));
  EXPECT_THAT([] { test::read_bytes(std::string(70000, ' ') + "\n"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("more than 65536 bytes")));
}

TEST(EventTextRecordingTest, reads_a_real_recording_part_by_part) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const auto reader = open_recording(*folder / "davis240c_slider_depth.txt");
  std::size_t parts = 0, events = 0;
  for (RecordingPart part; reader->next(part); ++parts) events += part.events.size();
  EXPECT_EQ(events, 50000u);
  EXPECT_EQ(parts, 5u);
  EXPECT_EQ(reader->progress(), 1.0);
}

}  // namespace
}  // namespace nightjar::camera
