#include "camera/aedat2_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "camera/trigger_types.h"
#include "tests/support/recordings.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::DoubleNear;
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

TEST(Aedat2ReaderTest, takes_signals_at_the_input_for_triggers) {
  const test::WholeRecording read =
      test::read_bytes(kHeader + record(1u << 10, 2) + record(1u << 10 | 2, 3) +
                       record(1u << 10 | 3, 4) + record(1u << 10 | 4, 5));
  EXPECT_THAT(read.all.triggers,
              ElementsAre(Trigger{Time(2), kExternalPulse}, Trigger{Time(3), kExternalFalling},
                          Trigger{Time(4), kExternalRising}, Trigger{Time(5), kExternalPulse}));
}

/// A read of an active pixel at column `x` of the file (from the right) and row `up`.
std::string aps(std::uint32_t x, std::uint32_t up, bool signal, std::uint32_t level,
                std::uint32_t t_us) {
  return record(1u << 31 | up << 22 | x << 12 | (signal ? 1u << 10 : 0u) | level, t_us);
}

constexpr core::Resolution kSmall{4, 3};
const std::string kNoChip = "#!AER-DAT2.0\r\n";

/// Of every pixel of a 4x3 sensor, column by column, one microsecond a column.
std::string all_pixels(bool signal, std::uint32_t t_us, std::uint32_t least_level) {
  std::string bytes;
  for (std::uint32_t x = 0; x < 4; ++x)
    for (std::uint32_t up = 0; up < 3; ++up)
      bytes += aps(x, up, signal, least_level + 10 * x + up, t_us + x);
  return bytes;
}

TEST(Aedat2ReaderTest, makes_frames_of_reset_reads_minus_signal_reads) {
  const test::WholeRecording read =
      test::read_bytes(kNoChip + all_pixels(false, 100, 900) + event(1, 1, true, 150) +
                           aps(0, 0, true, 901, 200) +  // darker than its reset: 0
                           all_pixels(true, 200, 600).substr(8) + event(1, 1, true, 300),
                       kSmall);
  EXPECT_FALSE(read.faults.any()) << read.faults.first;
  EXPECT_EQ(read.all.events.size(), 2u);
  ASSERT_EQ(read.all.frames.size(), 1u);
  const RecordedFrame& frame = read.all.frames[0];
  EXPECT_EQ(frame.gray.size(), kSmall);
  EXPECT_EQ(frame.bits, 10);
  EXPECT_EQ(frame.gray(3, 2), 0);    // column 0 from the right, row 0 from the bottom
  EXPECT_EQ(frame.gray(0, 0), 300);  // 900 - 600
  // A global shutter: all resets are read before the exposure, all signals after it.
  EXPECT_EQ(frame.frame_begin, Time(100));
  EXPECT_EQ(frame.exposure_begin, Time(103));
  EXPECT_EQ(frame.exposure_end, Time(200));
  EXPECT_EQ(frame.frame_end, Time(203));
}

TEST(Aedat2ReaderTest, lays_frames_where_the_events_are) {
  // The file's column of an active pixel counts from the right, that of an event from the left.
  const test::WholeRecording read =
      test::read_bytes(kNoChip + event(1, 2, true, 1) + aps(2, 2, false, 700, 2) +
                           aps(2, 2, true, 200, 9) + aps(2, 2, false, 700, 20),
                       kSmall);
  ASSERT_EQ(read.all.frames.size(), 1u);
  EXPECT_EQ(read.all.frames[0].left_px, read.all.events.at(0).x);
  EXPECT_EQ(read.all.frames[0].top_px, read.all.events.at(0).y);
}

/// The reads of one rolling frame: signals follow their resets a column later.
std::string rolling_frame(std::uint32_t t_us) {
  std::string bytes;
  for (std::uint32_t column = 0; column < 5; ++column)
    for (std::uint32_t up = 0; up < 3; ++up) {
      if (column < 4) bytes += aps(column, up, false, 500, t_us + 10 * column);
      if (column > 0) bytes += aps(column - 1, up, true, 400, t_us + 10 * column);
    }
  return bytes;
}

TEST(Aedat2ReaderTest, knows_a_rolling_shutter_by_signals_among_the_resets) {
  const test::WholeRecording read = test::read_bytes(kNoChip + rolling_frame(100), kSmall);
  ASSERT_EQ(read.all.frames.size(), 1u);
  EXPECT_EQ(read.all.frames[0].exposure_begin, Time(100));
  EXPECT_EQ(read.all.frames[0].exposure_end, Time(110));  // each pixel's is 10 us
  EXPECT_FALSE(read.faults.any()) << read.faults.first;
}

TEST(Aedat2ReaderTest, takes_a_rectangle_of_pixels_for_a_region_of_interest) {
  std::string region;
  for (const bool signal : {false, true})
    for (const std::uint32_t x : {1u, 2u})
      for (const std::uint32_t up : {0u, 1u})
        region += aps(x, up, signal, signal ? 300 : 350, signal ? 20 : 10);
  const test::WholeRecording read =  // two of them: the second ends with the file
      test::read_bytes(kNoChip + region + region, kSmall);
  ASSERT_EQ(read.all.frames.size(), 2u);
  for (const RecordedFrame& frame : read.all.frames) {
    EXPECT_EQ(frame.gray.size(), (core::Resolution{2, 2}));
    EXPECT_EQ(frame.left_px, 1);
    EXPECT_EQ(frame.top_px, 1);
    EXPECT_EQ(frame.gray(1, 1), 50);
  }
}

TEST(Aedat2ReaderTest, counts_frames_that_lost_reads_and_signals_without_their_resets) {
  const std::string resets = all_pixels(false, 100, 900), signals = all_pixels(true, 200, 600);
  const test::WholeRecording read =
      test::read_bytes(kNoChip + signals.substr(8 * 9) +     // began before the file
                           resets + signals.substr(8 * 5) +  // five signals lost
                           resets + signals,
                       kSmall);
  EXPECT_EQ(read.all.frames.size(), 1u);
  EXPECT_EQ(read.faults.packets_damaged, 3u + 1u);
  EXPECT_EQ(read.faults.first, "dark.rec: byte 14: record: of a frame or sample that is not whole");
}

TEST(Aedat2ReaderTest, loses_one_frame_alone_with_one_read) {
  const std::string frame = all_pixels(false, 100, 900) + all_pixels(true, 200, 600);
  for (std::size_t lost = 0; lost < 24; ++lost) {
    const test::WholeRecording read =
        test::read_bytes(kNoChip + std::string(frame).erase(8 * lost, 8) + frame + frame, kSmall);
    ASSERT_EQ(read.all.frames.size(), 2u) << lost;
    for (const RecordedFrame& whole : read.all.frames) EXPECT_EQ(whole.gray.size(), kSmall);
    // Of a reset that is lost its signal is left.
    EXPECT_EQ(read.faults.packets_damaged, lost < 12 ? 2u : 1u) << lost;
  }
}

TEST(Aedat2ReaderTest, gives_the_frames_of_a_file_that_begins_within_one) {
  const std::string global = all_pixels(false, 100, 900) + all_pixels(true, 200, 600);
  for (const std::string& frame : {global, rolling_frame(100)})
    for (std::size_t first = 1; first < 24; ++first) {
      const test::WholeRecording read =
          test::read_bytes(kNoChip + frame.substr(8 * first) + frame + frame, kSmall);
      ASSERT_EQ(read.all.frames.size(), 2u) << first;
      for (const RecordedFrame& whole : read.all.frames) EXPECT_EQ(whole.gray.size(), kSmall);
      EXPECT_GT(read.faults.packets_damaged, 0u) << first;
    }
}

TEST(Aedat2ReaderTest, passes_over_reads_of_another_kind_or_off_the_sensor) {
  const test::WholeRecording read = test::read_bytes(
      kNoChip + record(1u << 31 | 2u << 10, 1) + aps(4, 0, false, 1, 2) + aps(0, 3, true, 1, 2),
      kSmall);
  EXPECT_EQ(read.faults.packets_unknown, 1u);
  EXPECT_EQ(read.faults.events_outside, 2u);
}

/// The seven records of an inertial sample whose counts are 1000, 2000, ...
std::string imu(std::uint32_t t_us) {
  std::string bytes;
  for (std::uint32_t code = 0; code < 7; ++code)
    bytes += record(1u << 31 | code << 28 | (1000 * (code + 1)) << 12 | 3u << 10, t_us);
  return bytes;
}

TEST(Aedat2ReaderTest, reads_inertial_samples_by_the_scale_of_the_settings) {
  const std::string settings =
      "# <entry key=\"DAVIS240C.IMU.AccelScale\" value=\"ImuAccelScaleG4\"/>\r\n"
      "# <entry key=\"DAVIS240C.IMU.GyroScale\" value=\"GyroFullScaleDegPerSec500\"/>\r\n";
  for (const bool told : {false, true}) {
    const test::WholeRecording read = test::read_bytes(kHeader + (told ? settings : "") + imu(7));
    EXPECT_FALSE(read.faults.any()) << read.faults.first;
    ASSERT_EQ(read.all.imu.size(), 1u);
    const RecordedImu& sample = read.all.imu[0];
    EXPECT_EQ(sample.t, Time(7));
    // By default 8 g and 1000 deg/s over 2^15 counts, axes as imu_axes.h says.
    const double g_m_s2 = (told ? 4 : 8) / 32768.0 * 9.80665;
    const double rad_s = (told ? 500 : 1000) / 32768.0 * std::numbers::pi / 180;
    const auto near = [](double value) { return DoubleNear(value, 1e-6 * std::abs(value)); };
    EXPECT_THAT(sample.specific_force_camera_m_s2.x(), near(-1000 * g_m_s2));  // floats' rounding
    EXPECT_THAT(sample.specific_force_camera_m_s2.y(), near(2000 * g_m_s2));
    EXPECT_THAT(sample.specific_force_camera_m_s2.z(), near(-3000 * g_m_s2));
    EXPECT_THAT(static_cast<double>(sample.temperature_c), near(4000 / 340.0 + 35));
    EXPECT_THAT(sample.omega_camera_rad_s.x(), near(-5000 * rad_s));
    EXPECT_THAT(sample.omega_camera_rad_s.y(), near(6000 * rad_s));
    EXPECT_THAT(sample.omega_camera_rad_s.z(), near(-7000 * rad_s));
  }
}

TEST(Aedat2ReaderTest, counts_records_of_inertial_samples_that_are_not_whole) {
  const std::string one = imu(7);
  const test::WholeRecording read =
      test::read_bytes(kHeader + one.substr(8 * 5) + one.substr(0, 8 * 3) + one +
                       one.substr(0, 8 * 4));  // which the file's end cuts off
  EXPECT_EQ(read.all.imu.size(), 1u);
  EXPECT_EQ(read.faults.packets_damaged, 2u + 3u + 4u);
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
