#include "camera/aedat2_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/recordings.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;

const std::string kHeader =
    "#!AER-DAT2.0\r\n# This is a raw AE data file - do not edit\r\n"
    "# AEChip: eu.seebetter.ini.chips.davis.Davis240C\r\n";

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string record(std::uint32_t address, std::uint32_t t_us) {
  return big_endian(address) + big_endian(t_us);
}

/// `up`: the row, counted from the bottom.
std::string event(std::uint32_t x, std::uint32_t up, bool on, std::uint32_t t_us) {
  return record((up << 22) | (x << 12) | (on ? 1u << 11 : 0u), t_us);
}

TEST(Aedat2ReaderTest, reads_events_and_turns_the_rows_over) {
  const test::WholeRecording read =
      test::read_bytes(kHeader + event(239, 0, true, 5) + event(0, 179, false, 6));
  EXPECT_EQ(read.format, "AEDAT 2.0");
  EXPECT_EQ(read.size, (core::Resolution{240, 180}));
  EXPECT_THAT(read.all.events,
              ElementsAre(Event{Time(5), 239, 179, true}, Event{Time(6), 0, 0, false}));
  EXPECT_FALSE(read.faults.any()) << read.faults.first;
}

TEST(Aedat2ReaderTest, counts_samples_it_does_not_read_and_takes_pulses_for_triggers) {
  const test::WholeRecording read =
      test::read_bytes(kHeader + record(1u << 31, 1) + record(1u << 10, 2) + event(1, 1, true, 3));
  EXPECT_EQ(read.all.events.size(), 1u);
  EXPECT_THAT(read.all.triggers, ElementsAre(Trigger{Time(2), 4}));
  EXPECT_EQ(read.faults.packets_unknown, 1u);
  EXPECT_EQ(read.faults.first, "dark.rec: byte " + std::to_string(kHeader.size()) +
                                   ": record: of the active pixels or inertial sensor");
}

TEST(Aedat2ReaderTest, counts_on_where_31_or_32_bits_wrap) {
  const std::uint32_t end31 = 0x7fffffff, end32 = 0xffffffff;
  for (const std::uint32_t last : {end31, end32}) {
    const test::WholeRecording read =
        test::read_bytes(kHeader + event(1, 1, true, last) + event(1, 1, true, 4) +
                         event(1, 1, true, last - 1) + event(1, 1, true, 7));
    ASSERT_EQ(read.all.events.size(), 3u);
    EXPECT_EQ(read.all.events[1].t - read.all.events[0].t, Time(5));
    EXPECT_EQ(read.all.events[2].t - read.all.events[0].t, Time(8));
    EXPECT_EQ(read.faults.time_resets, 0u);
    EXPECT_EQ(read.faults.events_backwards, 1u);  // the one from before the wrap
  }
}

TEST(Aedat2ReaderTest, takes_a_long_step_back_for_a_reset_of_the_clock) {
  const test::WholeRecording read = test::read_bytes(kHeader + event(1, 1, true, 900'000'000) +
                                                     event(1, 1, true, 5) + event(1, 1, true, 8));
  ASSERT_EQ(read.all.events.size(), 3u);
  EXPECT_EQ(read.all.events[2].t, Time(900'000'003));
  EXPECT_EQ(read.faults.time_resets, 1u);
}

TEST(Aedat2ReaderTest, drops_rows_beyond_the_sensor) {
  const test::WholeRecording read =
      test::read_bytes(kHeader + event(0, 180, true, 1) + event(240, 0, true, 2));
  EXPECT_TRUE(read.all.events.empty());
  EXPECT_EQ(read.faults.events_outside, 2u);
}

TEST(Aedat2ReaderTest, delivers_what_is_whole_of_a_cut_file) {
  const std::string two = kHeader + event(1, 1, true, 1) + event(1, 1, true, 2);
  const test::WholeRecording read = test::read_bytes(two.substr(0, two.size() - 3));
  EXPECT_EQ(read.all.events.size(), 1u);
  EXPECT_EQ(read.faults.bytes_lost, 5u);
}

TEST(Aedat2ReaderTest, takes_an_event_that_begins_like_a_comment_for_an_event) {
  // Row 140 from the bottom has '#' for its first byte.
  const test::WholeRecording read = test::read_bytes(kHeader + event(1, 140, true, 0x0a));
  EXPECT_EQ(read.all.events.size(), 1u);
}

TEST(Aedat2ReaderTest, needs_a_size_for_a_camera_it_does_not_know) {
  EXPECT_THROW(test::read_bytes("#!AER-DAT2.0\r\n"), std::invalid_argument);
  EXPECT_EQ(test::read_bytes("#!AER-DAT2.0\r\n", core::Resolution{7, 8}).size,
            (core::Resolution{7, 8}));
}

}  // namespace
}  // namespace nightjar::camera
