#include "scenarios/recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "msg/event_parts.h"
#include "msg/log_writer.h"
#include "scenarios/log_recording.h"
#include "scenarios/process_roles.h"
#include "scenarios/step_reader.h"
#include "tests/support/recording_samples.h"
#include "tests/support/recordings.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::ThrowsMessage;

constexpr core::Resolution kSize{37, 23};
constexpr Time kUnix(1589163147368868);

class LogRecordingTest : public testing::Test {
 protected:
  /// `part` through a log of the name a.lcm.
  test::WholeRecording round_trip(const camera::RecordingPart& part) {
    const auto writer = create_recording(folder_ / "a.lcm", {kSize, "Night <owl>"});
    writer->write(part);
    writer->finish();
    EXPECT_TRUE(writer->not_carried().things().empty());
    return read("a.lcm");
  }

  test::WholeRecording read(const std::string& name,
                            std::optional<core::Resolution> size = std::nullopt) {
    return test::read_all(*open_recording(folder_ / name, size));
  }

  test::ScratchFolder folder_;
};

TEST_F(LogRecordingTest, keeps_every_list_bit_for_bit) {
  for (const Time begin : {Time(0), kUnix}) {
    camera::RecordingPart part = test::sample_part(kSize, begin);
    part.frames[0].bits = 16;
    part.frames[0].gray(1, 1) = 0xffff;
    part.frames[1].bits = 10;
    part.imu[3].omega_camera_rad_s.x() = 0.1234567890123;  // more digits than a float has
    const test::WholeRecording again = round_trip(part);
    EXPECT_EQ(test::difference(again.all, part), "") << begin.count();
    EXPECT_EQ(again.size, kSize);
    EXPECT_EQ(again.camera, "Night <owl>");
    EXPECT_EQ(again.format, "LCM log");
    EXPECT_FALSE(again.faults.any()) << again.faults.first;
  }
}

TEST_F(LogRecordingTest, keeps_a_recording_of_nothing_and_one_without_events) {
  EXPECT_EQ(test::difference(round_trip({}).all, {}), "");
  camera::RecordingPart part = test::sample_part(kSize, kUnix);
  part.events.clear();
  EXPECT_EQ(test::difference(round_trip(part).all, part), "");
}

TEST_F(LogRecordingTest, keeps_a_part_in_pieces_and_does_not_fill_the_disk_over_a_long_pause) {
  const camera::RecordingPart first = test::sample_part(kSize, 0s);
  const camera::RecordingPart second = test::sample_part(kSize, 24h * 365 * 100);
  const auto writer = create_recording(folder_ / "a.lcm", {kSize, ""});
  writer->write(first);
  writer->write(second);
  writer->finish();
  const auto all = read("a.lcm").all;
  EXPECT_EQ(all.events.size(), first.events.size() + second.events.size());
  EXPECT_EQ(all.events.back(), second.events.back());
  // Two seconds of events and the six frames; empty steps of a century would be 10^13 bytes.
  EXPECT_LT(std::filesystem::file_size(folder_ / "a.lcm"), 1'000'000u);
}

TEST_F(LogRecordingTest, takes_little_of_the_disk_for_events_far_apart) {
  camera::RecordingPart part;
  for (int i = 0; i < 100; ++i) part.events.push_back({kUnix + i * 59s, 1, 2, true});
  EXPECT_EQ(round_trip(part).all.events, part.events);
  // A packet of one event is 79 bytes in the log; 590,000 empty ones would be 42 MB.
  EXPECT_LT(std::filesystem::file_size(folder_ / "a.lcm"), 100u * 200u);
}

TEST_F(LogRecordingTest, keeps_more_events_of_one_moment_than_a_packet_takes) {
  camera::RecordingPart part;
  part.events.assign((1u << 21) + 1000, core::Event{kUnix, 1, 2, true});
  part.events.back().x = 5;
  EXPECT_EQ(round_trip(part).all.events, part.events);
}

TEST_F(LogRecordingTest, is_sent_by_replay_in_steps_of_10_milliseconds) {
  camera::RecordingPart part;
  part.events = {{kUnix + 1us, 1, 2, true}, {kUnix + 10ms, 3, 4, true}, {kUnix + 25ms, 5, 6, true}};
  round_trip(part);
  msg::Bus bus;
  std::vector<core::EventPacket> packets;
  bus.subscribe(msg::kEvents, [&](const core::EventPacket& p) { packets.push_back(p); });
  for (const auto steps = open_steps(folder_ / "a.lcm"); steps->next(bus);) bus.dispatch();
  ASSERT_EQ(packets.size(), 3u);
  EXPECT_EQ(packets[0].events.size(), 2u);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i].begin, kUnix + i * 10ms);
    EXPECT_EQ(packets[i].end, kUnix + (i + 1) * 10ms);
  }
}

/// A log of one flight's step, as lcm-logger hears it: with the copies that lock-step sends.
void write_heard(const std::filesystem::path& path, int copies) {
  msg::LogWriter log(path);
  for (const Time t : {10ms, 20ms}) {
    const core::EventPacket packet{t - 10ms, t, {{t - 1ms, 1, 2, true}, {t, 3, 4, false}}};
    msg::StepMark mark;
    mark.t = t;
    mark.sequence = t / 10ms;
    mark.sender = kFromSource.sender;
    for (int copy = 0; copy < copies; ++copy) {
      core::ImuSample sample;
      sample.t = t;
      log.write(msg::kImu.name, msg::encode(sample));
      for (const msg::Bytes& part : msg::cut_events(msg::encode(packet), mark.sequence, 1))
        log.write(msg::kEventParts, part);
      log.write(msg::kStep.name, msg::encode(mark));
    }
    log.write(msg::kPicture.name, msg::encode(core::Picture{t, core::Image<std::uint8_t>(kSize)}));
    log.write("OTHER", msg::Bytes(16));
  }
  log.finish();
}

TEST_F(LogRecordingTest, reads_what_lcm_logger_heard_once_however_often_it_was_sent) {
  for (const int copies : {1, 3}) {
    write_heard(folder_ / "heard.lcm", copies);
    const auto recording = open_recording(folder_ / "heard.lcm");
    const test::WholeRecording heard = test::read_all(*recording);
    EXPECT_EQ(heard.size, kSize);  // the pictures'
    EXPECT_EQ(heard.all.events.size(), 4u);
    EXPECT_EQ(heard.all.imu.size(), 2u);
    EXPECT_FALSE(heard.faults.any()) << heard.faults.first;
    EXPECT_THAT(recording->others(), ElementsAre(Pair("NIGHTJAR_PICTURE", 2), Pair("OTHER", 2)));
    msg::Bus bus;
    int steps = 0;
    for (const auto reader = open_steps(folder_ / "heard.lcm"); reader->next(bus); ++steps)
      bus.dispatch();
    EXPECT_EQ(steps, 2);
  }
}

TEST_F(LogRecordingTest, passes_over_and_counts_what_is_damaged) {
  {
    msg::LogWriter log(folder_ / "a.lcm");
    log.write(msg::kSensor.name, msg::encode(msg::SensorNote{{}, kSize, "D"}));
    log.write(msg::kEvents.name, msg::Bytes(40));  // no fingerprint
    log.write(msg::kEvents.name, msg::encode(core::EventPacket{0ms, 9ms, {{1ms, 1, 1, true}}}));
    log.write(msg::kEvents.name, msg::encode(core::EventPacket{9ms, 20ms, {{19ms, 37, 1, true}}}));
    log.finish();
  }
  const test::WholeRecording damaged = read("a.lcm");
  EXPECT_EQ(damaged.all.events.size(), 1u);
  EXPECT_EQ(damaged.faults.packets_damaged, 1u);
  EXPECT_EQ(damaged.faults.events_outside, 1u);
  // Behind the head of 28 bytes, the channel's 15 and the 30 of sensor_t.
  EXPECT_THAT(damaged.faults.first, HasSubstr("a.lcm: byte 73: message: event_packet_t"));
  std::filesystem::resize_file(folder_ / "a.lcm",
                               std::filesystem::file_size(folder_ / "a.lcm") - 1);
  EXPECT_GT(read("a.lcm").faults.bytes_lost, 0u);
}

TEST_F(LogRecordingTest, needs_a_size_where_nothing_in_the_log_tells_it) {
  msg::LogWriter log(folder_ / "a.lcm");
  log.write(msg::kEvents.name, msg::encode(core::EventPacket{0ms, 9ms, {{1ms, 1, 1, true}}}));
  log.finish();
  EXPECT_THAT([&] { read("a.lcm"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("does not tell the sensor's size")));
  EXPECT_EQ(read("a.lcm", kSize).all.events.size(), 1u);
  round_trip({});
  EXPECT_THAT(
      [&] {
        read("a.lcm", core::Resolution{1, 2});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("says 37x23 px, expected 1x2")));
}

TEST_F(LogRecordingTest, leaves_nothing_behind_when_it_refuses) {
  camera::RecordingPart off;
  off.events = {{1us, 37, 0, true}};
  EXPECT_THROW(create_recording(folder_ / "a.lcm", {kSize, ""})->write(off), std::invalid_argument);
  EXPECT_THROW(create_recording(folder_ / "a.lcm", {{0, 5}, ""}), std::invalid_argument);
  EXPECT_THROW(create_recording(folder_ / "none/a.lcm", {kSize, ""}), std::invalid_argument);
  EXPECT_THAT(
      [&] {
        create_recording(folder_ / "a.bag", {kSize, ""});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("or .lcm")));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(LogRecordingTest, opens_the_other_formats_too) {
  std::ofstream(folder_ / "e.txt") << "0.5 1 2 1\n";
  EXPECT_EQ(read("e.txt").format, "text");
  const auto writer = create_recording(folder_ / "a.aedat4", {kSize, ""});
  writer->finish();
  EXPECT_EQ(read("a.aedat4").format, "AEDAT4");
}

}  // namespace
}  // namespace nightjar::scenarios
