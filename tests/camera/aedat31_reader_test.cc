#include "camera/aedat31_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "tests/support/recordings.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kHeader =
    "#!AER-DAT3.1\r\n#Format: RAW\r\n#Source 1: DAVIS240C\r\n#Start-Time: 2017-03-09 10:00:00 "
    "(TZ+0100)\r\n#!END-HEADER\r\n";

template <class T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string packet(int type, int size, int overflow, int number, const std::string& events,
                   int source = 1) {
  const Aedat31PacketHeader header{static_cast<std::int16_t>(type),
                                   static_cast<std::int16_t>(source),
                                   size,
                                   4,
                                   overflow,
                                   number,
                                   number,
                                   number};
  return bytes_of(header) + events;
}

/// Valid, at (x, y) of the sensor.
std::string polarity(std::uint32_t x, std::uint32_t y, bool on, std::int32_t t) {
  return bytes_of(1u | (on ? 2u : 0u) | (y << 2) | (x << 17)) + bytes_of(t);
}

std::string special(std::uint32_t type, std::int32_t t) {
  return bytes_of(1u | (type << 1)) + bytes_of(t);
}

std::string error_of(const std::string& bytes) {
  try {
    test::read_bytes(bytes);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Aedat31ReaderTest, reads_events_in_the_places_of_their_bits) {
  const test::WholeRecording read = test::read_bytes(
      kHeader + packet(1, 8, 0, 2, polarity(239, 3, true, 5) + polarity(1, 179, false, 6)));
  EXPECT_EQ(read.format, "AEDAT 3.1");
  EXPECT_EQ(read.camera, "DAVIS240C");
  EXPECT_EQ(read.size, (core::Resolution{240, 180}));
  EXPECT_THAT(read.all.events,
              ElementsAre(Event{Time(5), 239, 3, true}, Event{Time(6), 1, 179, false}));
}

TEST(Aedat31ReaderTest, passes_over_events_that_are_marked_invalid) {
  std::string invalid = polarity(1, 1, true, 7);
  invalid[0] = static_cast<char>(invalid[0] & ~1);
  const test::WholeRecording read =
      test::read_bytes(kHeader + packet(1, 8, 0, 2, invalid + polarity(1, 1, true, 8)));
  EXPECT_THAT(read.all.events, ElementsAre(Event{Time(8), 1, 1, true}));
  EXPECT_FALSE(read.faults.any());
}

TEST(Aedat31ReaderTest, counts_on_where_31_bits_wrap) {
  const test::WholeRecording read =
      test::read_bytes(kHeader + packet(1, 8, 0, 1, polarity(1, 1, true, 0x7fffffff)) +
                       packet(0, 8, 1, 1, special(0, 0)) +  // the wrap itself
                       packet(1, 8, 1, 1, polarity(1, 1, true, 0)));
  ASSERT_EQ(read.all.events.size(), 2u);
  EXPECT_EQ(read.all.events[1].t - read.all.events[0].t, Time(1));
  EXPECT_EQ(read.all.events[1].t, Time(std::int64_t{1} << 31));
  EXPECT_TRUE(read.all.triggers.empty());
  EXPECT_FALSE(read.faults.any()) << read.faults.first;
}

TEST(Aedat31ReaderTest, goes_on_from_the_latest_time_after_a_reset_of_the_clock) {
  const test::WholeRecording read = test::read_bytes(
      kHeader + packet(1, 8, 0, 1, polarity(1, 1, true, 300)) + packet(0, 8, 0, 1, special(1, 0)) +
      packet(1, 8, 0, 2, polarity(1, 1, true, 10) + polarity(1, 1, true, 15)));
  ASSERT_EQ(read.all.events.size(), 3u);
  EXPECT_EQ(read.all.events[1].t, Time(300));
  EXPECT_EQ(read.all.events[2].t, Time(305));
  EXPECT_EQ(read.faults.time_resets, 1u);
  EXPECT_EQ(read.faults.events_backwards, 0u);
}

TEST(Aedat31ReaderTest, undoes_a_wrap_within_a_frame) {
  std::string frame = bytes_of(3u);
  for (const std::int32_t number : {0x7ffffff0, 0x20, 0x7ffffff8, 0x10, 2, 1, 4, 5})
    frame += bytes_of(number);
  frame += bytes_of(std::uint16_t{0xff00}) + bytes_of(std::uint16_t{0x0100});
  const test::WholeRecording read = test::read_bytes(kHeader + packet(2, 40, 0, 1, frame));
  ASSERT_EQ(read.all.frames.size(), 1u) << read.faults.first;
  const RecordedFrame& found = read.all.frames[0];
  EXPECT_EQ(found.exposure_end - found.exposure_begin, Time(0x18));
  EXPECT_EQ(found.frame_end - found.frame_begin, Time(0x30));
  EXPECT_EQ(found.left_px, 4);
  EXPECT_EQ(found.top_px, 5);
  EXPECT_EQ(found.bits, 8);
  EXPECT_EQ(found.gray(0, 0), 255);
  EXPECT_EQ(found.gray(1, 0), 1);
}

TEST(Aedat31ReaderTest, delivers_the_whole_events_of_a_cut_packet) {
  const std::string two =
      kHeader + packet(1, 8, 0, 2, polarity(1, 1, true, 5) + polarity(1, 1, true, 6));
  for (std::size_t cut = 0; cut < 16; ++cut) {
    const test::WholeRecording read = test::read_bytes(two.substr(0, two.size() - 16 + cut));
    EXPECT_EQ(read.all.events.size(), cut / 8) << cut;
    EXPECT_EQ(read.faults.bytes_lost, cut % 8) << cut;
    EXPECT_THAT(read.faults.first,
                StartsWith(fmt::format("dark.rec: byte {}: packet", kHeader.size())));
  }
}

TEST(Aedat31ReaderTest, counts_packets_it_does_not_know_and_other_sources) {
  const test::WholeRecording read = test::read_bytes(
      kHeader + packet(12, 8, 0, 1, std::string(8, '\1')) +
      packet(1, 8, 0, 1, polarity(1, 1, true, 5)) + packet(1, 8, 0, 1, polarity(2, 2, true, 5), 2));
  EXPECT_EQ(read.all.events.size(), 1u);
  EXPECT_EQ(read.faults.packets_unknown, 2u);
}

TEST(Aedat31ReaderTest, counts_packets_and_frames_of_sizes_that_cannot_be) {
  std::string frame = bytes_of(3u);
  for (const std::int32_t number : {0, 0, 0, 0, 32767, 32767, 0, 0}) frame += bytes_of(number);
  EXPECT_EQ(test::read_bytes(kHeader + packet(2, 36, 0, 1, frame)).faults.packets_damaged, 1u);
  EXPECT_EQ(test::read_bytes(kHeader + packet(1, 4, 0, 1, "abcd")).faults.packets_damaged, 1u);
  for (const auto& [size, number] : {std::pair{0, 5}, {-8, 5}, {8, -1}, {1 << 30, 1 << 30}})
    EXPECT_EQ(test::read_bytes(kHeader + packet(1, size, 0, number, "tail")).faults.bytes_lost,
              28u + 4u);
}

TEST(Aedat31ReaderTest, refuses_headers_that_say_too_little_or_something_else) {
  EXPECT_THAT(error_of("#!AER-DAT3.1\r\n#Source 1: Retina\r\n#!END-HEADER\r\n"),
              HasSubstr("does not tell the sensor's size"));
  EXPECT_THAT(error_of("#!AER-DAT3.1\r\n#Format: PNGFrames\r\n#!END-HEADER\r\n"),
              "dark.rec: byte 14: another format than RAW");
  EXPECT_THAT(error_of("#!AER-DAT3.1\r\n#Source 1: DAVIS346\r\n"), HasSubstr("byte 35: "));
  EXPECT_THAT(error_of("#!AER-DAT3.0\r\n"), "dark.rec: AEDAT 3.0, allowed 2.0, 3.1 and 4.0");
  EXPECT_THAT(error_of("#!AER-DAT3.1\r\n#Sensor: A 0x7\r\n#!END-HEADER\r\n"),
              HasSubstr("0x7 px, allowed 1 to 32767"));
}

}  // namespace
}  // namespace nightjar::camera
