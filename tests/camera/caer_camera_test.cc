#include "camera/caer_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <thread>

#include "tests/support/camera_caer_double.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using std::chrono::microseconds;
using test::caer_events_at;
using test::CaerDouble;
using test::CaerDoubleContainer;
using test::CaerDoubleSession;
using testing::ElementsAre;
using testing::HasSubstr;

/// A camera on the bench, all that it said, and how it came out.
class CaerCameraTest : public testing::Test {
 protected:
  void plug_in(std::vector<CaerDoubleSession> sessions) {
    bench_ = std::make_unique<CaerDouble>(std::move(sessions));
    camera_ =
        std::make_unique<CaerCamera>(config_, bench_->opener(), [this] { return bench_->now(); });
  }

  /// Everything up to the silence that follows the last container.
  void play() {
    bench_->silence_times_out = true;
    camera_->start();
    for (LivePacket packet;;) {
      arrivals_.push_back(camera_->next(packet));
      if (arrivals_.back() == Arrival::packet) packets_.push_back(packet);
      if (arrivals_.back() == Arrival::silent && bench_->opened == sessions_wanted_) return;
    }
  }

  std::string start_error() {
    try {
      camera_->start();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  }

  std::vector<core::Event> events() const {
    std::vector<core::Event> all;
    for (const LivePacket& packet : packets_)
      all.insert(all.end(), packet.events.begin(), packet.events.end());
    return all;
  }

  static CaerConfig quick() {
    CaerConfig config;
    config.reconnect.first_pause_ms = config.reconnect.most_pause_ms = 1.0;
    return config;
  }

  CaerConfig config_ = quick();
  int sessions_wanted_ = 1;
  std::unique_ptr<CaerDouble> bench_;
  std::unique_ptr<CaerCamera> camera_;
  std::vector<LivePacket> packets_;
  std::vector<Arrival> arrivals_;
};

TEST_F(CaerCameraTest, hands_over_what_the_camera_sees) {
  plug_in({{.containers = {{.packets = {caer_events_at(0, {100, 200}),
                                        test::caer_packet(3, 36, 0, 1, test::caer_imu6(210))},
                            .host_time = microseconds(5000)},
                           {.packets = {test::caer_packet(
                                2, 40, 0, 1, test::caer_frame(150, 260, {0xff00, 0x0000}))}}}}});
  play();
  ASSERT_EQ(packets_.size(), 2u);
  EXPECT_THAT(packets_[0].events,
              ElementsAre(Event{Time(100), 7, 9, true}, Event{Time(200), 7, 9, true}));
  ASSERT_EQ(packets_[0].imu.size(), 1u);
  EXPECT_EQ(packets_[0].begin, Time(99));
  EXPECT_EQ(packets_[0].end, Time(210));
  EXPECT_EQ(packets_[0].received.time_since_epoch(), microseconds(5000));
  ASSERT_EQ(packets_[1].frames.size(), 1u);
  EXPECT_EQ(packets_[1].frames[0].bits, 10);  // though these levels would go into 8
  EXPECT_THAT(packets_[1].frames[0].gray.pixels(), ElementsAre(1020, 0));
  EXPECT_EQ(packets_[1].begin, Time(210));
  EXPECT_EQ(packets_[1].end, Time(260));
  const SourceCounts counts = camera_->counts();
  EXPECT_EQ(counts.packets, 2u);
  EXPECT_EQ(counts.events, 2u);
  EXPECT_EQ(counts.frames, 1u);
  EXPECT_EQ(counts.imu, 1u);
  EXPECT_FALSE(counts.any_loss());
  EXPECT_EQ(camera_->name(), "DAVIS346 00000123");
}

TEST_F(CaerCameraTest, goes_on_where_31_bits_wrap) {
  constexpr std::int32_t kLast = 0x7fffffff;
  plug_in(
      {{.containers = {{.packets = {caer_events_at(0, {kLast - 9999, kLast}),
                                    test::caer_packet(0, 8, 0, 1, test::caer_special(0, kLast))}},
                       {.packets = {caer_events_at(1, {0, 10'000})}}}}});
  play();
  ASSERT_EQ(packets_.size(), 2u);
  EXPECT_EQ(packets_[1].events[0].t - packets_[0].events[1].t, Time(1));
  EXPECT_EQ(packets_[1].end - packets_[0].end, Time(10'001));
  EXPECT_FALSE(camera_->counts().any_loss());
}

TEST_F(CaerCameraTest, goes_on_after_a_reset_of_the_clock) {
  plug_in({{.containers = {
                {.packets = {caer_events_at(0, {5'000'000, 5'000'100})}},
                {.packets = {test::caer_packet(0, 8, 0, 1, test::caer_special(1, 0x7fffffff))}},
                {.packets = {caer_events_at(0, {0, 50})}}}}});
  play();
  ASSERT_EQ(packets_.size(), 2u);  // the reset alone is not worth a packet
  EXPECT_EQ(packets_[1].begin, Time(5'000'100));
  EXPECT_EQ(packets_[1].events[0].t, Time(5'000'101));  // not older than the packet
  EXPECT_EQ(packets_[1].events[1].t, Time(5'000'150));
  EXPECT_EQ(camera_->counts().faults.time_resets, 1u);
}

TEST_F(CaerCameraTest, counts_what_the_full_buffer_dropped_and_marks_the_gap) {
  plug_in({{.containers = {{.packets = {caer_events_at(0, {10})}},
                           {.packets = {caer_events_at(0, {50})}, .lost_before = 3},
                           {.packets = {caer_events_at(0, {60})}}}}});
  play();
  ASSERT_EQ(packets_.size(), 3u);
  EXPECT_FALSE(packets_[0].gap);
  EXPECT_TRUE(packets_[1].gap);
  EXPECT_FALSE(packets_[2].gap);
  EXPECT_EQ(camera_->counts().packets_lost, 3u);
}

TEST_F(CaerCameraTest, reports_a_lost_camera_once_and_goes_on_when_it_is_back) {
  sessions_wanted_ = 2;
  plug_in({{.containers = {{.packets = {caer_events_at(0, {1'000'000})},
                            .host_time = microseconds(9'000'000)}},
            .unplugged_then = true},
           {.failures_before = 3,
            .containers = {{.packets = {caer_events_at(0, {100, 200})},
                            .host_time = microseconds(11'500'000)}}}});
  play();
  EXPECT_THAT(arrivals_,
              ElementsAre(Arrival::packet, Arrival::disconnected, Arrival::silent, Arrival::silent,
                          Arrival::silent, Arrival::packet, Arrival::silent));
  ASSERT_EQ(packets_.size(), 2u);
  EXPECT_TRUE(packets_[1].gap);
  // The camera's clock began anew; 2.5 s went by on the computer's.
  EXPECT_EQ(packets_[1].begin, Time(1'000'000));
  EXPECT_EQ(packets_[1].end, Time(3'500'000));
  EXPECT_EQ(packets_[1].events[0].t, Time(3'499'900));
  EXPECT_EQ(camera_->counts().disconnects, 1u);
  EXPECT_EQ(camera_->counts().reconnects, 1u);
  EXPECT_EQ(bench_->opened, 2);
}

TEST_F(CaerCameraTest, sends_its_settings_to_a_camera_that_is_back) {
  sessions_wanted_ = 2;
  config_.exposure_ms = 2.5;
  plug_in({{.unplugged_then = true}, {}});
  bench_->silence_times_out = true;
  camera_->start();
  LivePacket packet;
  EXPECT_EQ(camera_->next(packet), Arrival::disconnected);
  bench_->settings.clear();
  EXPECT_EQ(camera_->next(packet), Arrival::silent);
  EXPECT_EQ(bench_->settings.at({2, 12}), 2500u);
}

TEST_F(CaerCameraTest, survives_packets_that_cannot_be_and_sums_faults_over_openings) {
  sessions_wanted_ = 2;
  const std::string whole = caer_events_at(0, {10});
  plug_in({{.containers = {{.packets = {whole.substr(0, 30), ""}},
                           {.packets = {test::caer_packet(1, 8, 0, 1,
                                                          test::caer_polarity(346, 0, true, 5))}}},
            .unplugged_then = true},
           {.containers = {{.packets = {whole.substr(0, 20)}}, {.packets = {whole}}}}});
  play();
  ASSERT_EQ(packets_.size(), 1u);
  const RecordingFaults faults = camera_->counts().faults;
  EXPECT_EQ(faults.packets_damaged, 3u);
  EXPECT_EQ(faults.events_outside, 1u);
  EXPECT_THAT(faults.first, HasSubstr("DAVIS346 00000123: container 0: "));
}

// Events at the seams of packets, at a tenth of a second of host time each: the contract of
// EventSource whatever the camera's clock does.
TEST_F(CaerCameraTest, gives_packets_that_follow_each_other_without_overlap) {
  sessions_wanted_ = 3;
  std::vector<CaerDoubleSession> sessions(3);
  std::int64_t host_us = 0;
  for (CaerDoubleSession& session : sessions) {
    for (int i = 0; i < 20; ++i)
      session.containers.push_back({.packets = {caer_events_at(0, {i * 10, i * 10 + 10})},
                                    .host_time = microseconds(host_us += 100'000)});
    session.unplugged_then = &session != &sessions.back();
  }
  plug_in(std::move(sessions));
  play();
  ASSERT_EQ(packets_.size(), 60u);
  Time end = packets_.front().begin;
  for (const LivePacket& packet : packets_) {
    EXPECT_EQ(packet.begin, end);
    for (const core::Event& event : packet.events) {
      EXPECT_GT(event.t, packet.begin);
      EXPECT_LE(event.t, packet.end);
    }
    end = packet.end;
  }
  EXPECT_EQ(events().size(), 120u);
  EXPECT_EQ(camera_->counts().faults.events_backwards, 0u);
}

TEST_F(CaerCameraTest, plays_an_aedat_recording_through_the_same_code) {
  std::string packets[40];
  std::string file = "#!AER-DAT3.1\r\n#Source 1: DAVIS346\r\n#!END-HEADER\r\n";
  CaerDoubleSession session;
  for (int i = 0; i < 40; ++i) {
    const std::int32_t t_us = 10'000 * i;
    packets[i] = caer_events_at(0, {t_us + 1, t_us + 5'000, t_us + 10'000});
    file += packets[i];
    session.containers.push_back({.packets = {packets[i]}});
  }
  plug_in({session});
  play();
  const auto reader = open_recording(std::make_unique<std::istringstream>(file), "road");
  std::vector<core::Event> recorded;
  for (RecordingPart part; reader->next(part);)
    recorded.insert(recorded.end(), part.events.begin(), part.events.end());
  EXPECT_EQ(recorded.size(), 120u);
  EXPECT_EQ(events(), recorded);
}

TEST_F(CaerCameraTest, stops_while_the_camera_is_silent) {
  plug_in({{.containers = {{.packets = {caer_events_at(0, {10})}}}}});
  camera_->start();
  LivePacket packet;
  ASSERT_EQ(camera_->next(packet), Arrival::packet);
  Arrival last = Arrival::packet;
  std::thread reader([&] { last = camera_->next(packet); });  // waits for ever but for stop()
  bench_->wait_for_silence();
  EXPECT_EQ(camera_->counts().packets, 1u);
  camera_->stop();
  reader.join();
  EXPECT_EQ(last, Arrival::end);
  EXPECT_EQ(camera_->next(packet), Arrival::end);
  EXPECT_TRUE(packet.events.empty());
}

TEST_F(CaerCameraTest, stops_while_it_waits_for_the_camera_to_come_back) {
  config_.reconnect.first_pause_ms = config_.reconnect.most_pause_ms = 60'000.0;
  plug_in({{.unplugged_then = true}});
  camera_->start();
  LivePacket packet;
  ASSERT_EQ(camera_->next(packet), Arrival::disconnected);
  std::thread stopper([&] { camera_->stop(); });
  while (camera_->next(packet) != Arrival::end) {
  }
  stopper.join();
  EXPECT_EQ(bench_->opened, 1);
}

TEST_F(CaerCameraTest, stops_at_any_moment_of_comings_and_goings) {
  for (int round = 0; round < 50; ++round) {
    std::vector<CaerDoubleSession> sessions(20, {.failures_before = 1,
                                                 .containers = std::vector<CaerDoubleContainer>(
                                                     20, {.packets = {caer_events_at(0, {10})}}),
                                                 .unplugged_then = true});
    sessions.front().failures_before = 0;
    plug_in(std::move(sessions));
    camera_->start();
    std::thread stopper([&, round] {
      while (camera_->counts().packets < static_cast<std::uint64_t>(round))
        std::this_thread::yield();
      camera_->stop();
    });
    LivePacket packet;
    while (camera_->next(packet) != Arrival::end) {
    }
    stopper.join();
  }
}

TEST_F(CaerCameraTest, does_not_begin_once_stopped) {
  plug_in({{.containers = {{.packets = {caer_events_at(0, {10})}}}}});
  camera_->stop();
  camera_->start();
  LivePacket packet;
  EXPECT_EQ(camera_->next(packet), Arrival::end);
}

TEST_F(CaerCameraTest, says_that_there_is_no_camera_or_another_one) {
  config_.serial = "00000777";
  plug_in({});
  EXPECT_EQ(start_error(), "no camera on the bench");
  EXPECT_EQ(bench_->serial_asked, "00000777");
  plug_in({{}});
  bench_->info.chip = 2;
  bench_->info.size = {240, 180};
  EXPECT_EQ(start_error(), "camera 00000123: chip 2 of 240x180, allowed is a DAVIS346 of 346x260");
}

TEST_F(CaerCameraTest, refuses_settings_out_of_range) {
  config_.biases.off.coarse = 8;
  try {
    plug_in({{}});
    FAIL() << "took it";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "source.caer.biases.off.coarse = 8, allowed 0 to 7");
  }
}

}  // namespace
}  // namespace nightjar::camera
