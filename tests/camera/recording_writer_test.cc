#include "camera/recording_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/data_folder.h"
#include "tests/support/recording_samples.h"
#include "tests/support/recordings.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr core::Resolution kDavis346{346, 260};
constexpr core::Resolution kOdd{37, 23};
constexpr Time kUnix(1589163147368868);
constexpr Time kWrap(std::int64_t{1} << 31);

void write(const std::filesystem::path& path, core::Resolution size, const RecordingPart& part,
           Compression compression = Compression::lz4) {
  const auto writer = create_recording(path, {size, "Night <owl> & \"co\""}, compression);
  writer->write(part);
  writer->finish();
}

/// A file's name and how its packets are packed.
struct Kind {
  const char* name;
  Compression compression;
};

class RoundTripTest : public testing::TestWithParam<Kind> {
 protected:
  test::WholeRecording round_trip(core::Resolution size, const RecordingPart& part) {
    write(folder_ / GetParam().name, size, part, GetParam().compression);
    return test::read_all(folder_ / GetParam().name);
  }
  test::ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, RoundTripTest,
                         testing::Values(Kind{"lz4.aedat4", Compression::lz4},
                                         Kind{"lz4_high.aedat4", Compression::lz4_high},
                                         Kind{"zstd.aedat4", Compression::zstd},
                                         Kind{"zstd_high.aedat4", Compression::zstd_high},
                                         Kind{"plain.aedat4", Compression::none},
                                         Kind{"davis.aedat", Compression::none}),
                         [](const auto& instance) {
                           const std::string name = instance.param.name;
                           return name.substr(0, name.find('.'));
                         });

TEST_P(RoundTripTest, keeps_every_list_bit_for_bit) {
  for (const Time begin : {Time(0), kUnix, kWrap * 7 - Time(500'000)}) {  // wraps on the way
    const RecordingPart part = test::sample_part(kDavis346, begin);
    const test::WholeRecording again = round_trip(kDavis346, part);
    EXPECT_EQ(test::difference(again.all, part), "") << begin.count();
    EXPECT_FALSE(again.faults.any()) << again.faults.first;
  }
}

TEST_P(RoundTripTest, keeps_the_camera_and_a_size_that_no_camera_has) {
  const test::WholeRecording again = round_trip(kOdd, test::sample_part(kOdd, kUnix));
  EXPECT_EQ(again.size, kOdd);
  EXPECT_EQ(again.camera, "Night <owl> & \"co\"");
}

TEST_P(RoundTripTest, keeps_a_recording_of_nothing) {
  const test::WholeRecording again = round_trip(kDavis346, {});
  EXPECT_EQ(test::difference(again.all, {}), "");
  EXPECT_EQ(again.size, kDavis346);
  EXPECT_FALSE(again.faults.any()) << again.faults.first;
}

TEST_P(RoundTripTest, keeps_the_corners_of_the_largest_sensor) {
  RecordingPart part;
  part.events = {{kUnix, 0, 0, true}, {kUnix, 32766, 0, false}, {kUnix, 32766, 32766, true}};
  const test::WholeRecording again = round_trip({32767, 32767}, part);
  EXPECT_EQ(again.all.events, part.events);
}

TEST_P(RoundTripTest, keeps_the_real_recording) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const test::WholeRecording road = test::read_all(*folder / "davis346_road.aedat4");
  EXPECT_EQ(test::difference(round_trip(kDavis346, road.all).all, road.all), "");
}

TEST(RecordingWriterTest, keeps_ten_bits_in_aedat31_and_says_that_aedat4_does_not) {
  const test::ScratchFolder folder;
  RecordingPart part;
  part.frames.emplace_back();
  part.frames[0].bits = 10;
  part.frames[0].gray = core::Image<std::uint16_t>(kOdd, 1021);
  write(folder / "a.aedat", kOdd, part);
  EXPECT_EQ(test::difference(test::read_all(folder / "a.aedat").all, part), "");
  const auto writer = create_recording(folder / "a.aedat4", {kOdd, ""});
  writer->write(part);
  EXPECT_THAT(writer->not_carried().things(), ElementsAre("1 frames' bits beyond 8"));
  writer->finish();
  EXPECT_EQ(test::read_all(folder / "a.aedat4").all.frames.at(0).gray(0, 0), 1021 >> 2);
}

TEST(RecordingWriterTest, says_that_floats_round_what_a_simulator_measured) {
  const test::ScratchFolder folder;
  RecordingPart part = test::sample_part(kOdd, kUnix);
  part.imu[7].omega_camera_rad_s.x() = 0.1234567890123;
  for (const char* name : {"a.aedat4", "a.aedat"}) {
    const auto writer = create_recording(folder / name, {kOdd, ""});
    writer->write(part);
    EXPECT_THAT(writer->not_carried().things(),
                ElementsAre("1 IMU samples' digits beyond those of a float"));
  }
}

TEST(RecordingWriterTest, says_what_text_cannot_carry) {
  const test::ScratchFolder folder;
  const RecordingPart part = test::sample_part(kOdd, kUnix);
  const auto writer = create_recording(folder / "a.txt", {kOdd, ""});
  writer->write(part);
  writer->finish();
  EXPECT_THAT(writer->not_carried().things(), ElementsAre("the sensor's size and name", "3 frames",
                                                          "100 IMU samples", "10 triggers"));
  EXPECT_EQ(test::read_all(folder / "a.txt", kOdd).all.events, part.events);
}

TEST(RecordingWriterTest, refuses_what_could_not_be_read_back) {
  const test::ScratchFolder folder;
  RecordingPart off, negative, backwards, upside_down, type;
  off.events = {{Time(1), 37, 0, true}};
  negative.imu.emplace_back();
  negative.imu[0].t = Time(-1);
  backwards.events = {{Time(2), 0, 0, true}, {Time(1), 0, 0, true}};
  upside_down.frames.emplace_back();
  upside_down.frames[0].gray = core::Image<std::uint16_t>(kOdd);
  upside_down.frames[0].exposure_begin = Time(5);
  type.triggers = {{Time(1), 128}};
  for (const char* name : {"a.aedat4", "a.aedat", "a.txt"})
    for (const RecordingPart* part : {&off, &negative, &backwards, &upside_down, &type})
      EXPECT_THROW(create_recording(folder / name, {kOdd, ""})->write(*part),
                   std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(RecordingWriterTest, refuses_names_and_sensors_that_are_none) {
  const test::ScratchFolder folder;
  EXPECT_THAT(
      [&] {
        create_recording(folder / "a.bag", {kOdd, ""});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("allowed a name ending in .aedat4")));
  EXPECT_THROW(create_recording(folder / "a.aedat4", {{0, 5}, ""}), std::invalid_argument);
  EXPECT_THROW(create_recording(folder / "none/a.aedat4", {kOdd, ""}), std::invalid_argument);
}

TEST(RecordingWriterTest, lets_no_name_of_a_camera_break_the_header) {
  const test::ScratchFolder folder;
  const auto writer = create_recording(folder / "a.aedat", {kOdd, "x\r\n#!END-HEADER\r\n"});
  writer->finish();
  EXPECT_EQ(test::read_all(folder / "a.aedat").camera, "x??#!END-HEADER??");
}

}  // namespace
}  // namespace nightjar::camera
