#include "msg/log_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <lcm/lcm-cpp.hpp>

#include "tests/support/scratch_folder.h"

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;

struct Logged {
  std::int64_t time_us;
  std::string channel;
  Bytes bytes;

  friend bool operator==(const Logged&, const Logged&) = default;
};

/// What LCM's own reader finds in a log.
std::vector<Logged> read_log(const std::filesystem::path& path) {
  lcm::LogFile log(path.string(), "r");
  std::vector<Logged> all;
  if (!log.good()) return all;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    all.push_back({event->timestamp, event->channel, Bytes(data, data + event->datalen)});
  }
  return all;
}

core::Picture picture_at(core::Time t) {
  core::Picture picture{t, core::Image<std::uint8_t>({346, 260})};
  picture.gray(7, 11) = static_cast<std::uint8_t>(t.count());
  return picture;
}

core::VehicleState state_at(core::Time t) {
  core::VehicleState state;
  state.t = t;
  state.p_world_body_m.x() = 0.1 * static_cast<double>(t.count());
  return state;
}

/// Flies twenty pictures and states past a writer; returns what should be logged.
std::vector<Logged> record_run(LogWriter& log) {
  Bus bus;
  std::vector<Logged> sent;
  log.record(bus, kPicture);
  log.record(bus, kVehicleState);
  for (core::Time t = 10ms; t <= 200ms; t += 10ms) {
    bus.publish(kPicture, picture_at(t));
    bus.publish(kVehicleState, state_at(t));
    bus.publish(kAttitudeSetpoint, core::AttitudeSetpoint{});  // not recorded
    bus.dispatch();
    sent.push_back({t.count(), kPicture.name, encode(picture_at(t))});
    sent.push_back({t.count(), kVehicleState.name, encode(state_at(t))});
  }
  return sent;
}

TEST(LogWriter, WritesWhatLcmsOwnReaderReadsBack) {
  const test::ScratchFolder folder;
  LogWriter log(folder / "run.lcm");
  const std::vector<Logged> sent = record_run(log);
  log.finish();
  EXPECT_EQ(read_log(folder / "run.lcm"), sent);
}

TEST(LogWriter, EqualRunsGiveEqualFiles) {
  const test::ScratchFolder folder;
  for (const char* name : {"a.lcm", "b.lcm"}) {
    LogWriter log(folder / name);
    record_run(log);
    log.finish();
  }
  const std::string a = test::file_text(folder / "a.lcm");
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(a == test::file_text(folder / "b.lcm"));
}

TEST(LogWriter, WritesALogThatLcmReplays) {
  const test::ScratchFolder folder;
  LogWriter log(folder / "run.lcm");
  const std::vector<Logged> sent = record_run(log);
  log.finish();

  lcm::LCM replay("file://" + (folder / "run.lcm").string() + "?speed=0");
  ASSERT_TRUE(replay.good());
  std::vector<Bytes> got;
  replay.subscribeFunction<std::vector<Bytes>*>(
      ".*",
      [](const lcm::ReceiveBuffer* buffer, const std::string&, std::vector<Bytes>* all) {
        const auto* data = static_cast<const std::uint8_t*>(buffer->data);
        all->emplace_back(data, data + buffer->data_size);
      },
      &got);
  while (replay.handle() == 0) {
  }
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(got[i], sent[i].bytes) << i;
}

TEST(LogWriter, WritesALogThatLcmLogplayerPlays) {
  if (std::system("command -v lcm-logplayer >/dev/null") != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  const test::ScratchFolder folder;
  LogWriter log(folder / "run.lcm");
  const std::vector<Logged> sent = record_run(log);
  log.finish();

  const std::string copy = (folder / "copy.lcm").string();
  const std::string command = "lcm-logplayer --lcm-url='file://" + copy + "?mode=w' --speed=100 " +
                              (folder / "run.lcm").string() + " >/dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  const std::vector<Logged> played = read_log(copy);
  ASSERT_EQ(played.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(played[i].bytes, sent[i].bytes) << i;
}

TEST(LogWriter, HasItsOwnNameOnlyOnceFinished) {
  const test::ScratchFolder folder;
  LogWriter log(folder / "run.lcm");
  record_run(log);
  EXPECT_FALSE(std::filesystem::exists(folder / "run.lcm"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run.part.lcm"));
  log.finish();
  EXPECT_TRUE(std::filesystem::exists(folder / "run.lcm"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run.part.lcm"));
}

TEST(LogWriter, LeavesNothingWhenTheRunIsAborted) {
  const test::ScratchFolder folder;
  {
    LogWriter log(folder / "run.lcm");
    record_run(log);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(LogWriter, IgnoresMessagesAfterItIsFinished) {
  const test::ScratchFolder folder;
  Bus bus;
  LogWriter log(folder / "run.lcm");
  log.record(bus, kVehicleState);
  bus.publish(kVehicleState, state_at(1us));
  bus.dispatch();
  log.finish();
  bus.publish(kVehicleState, state_at(2us));
  bus.dispatch();
  EXPECT_EQ(read_log(folder / "run.lcm").size(), 1u);
}

TEST(LogWriter, RefusesAFolderThatDoesNotExist) {
  const test::ScratchFolder folder;
  EXPECT_THROW(LogWriter(folder / "nowhere/run.lcm"), std::invalid_argument);
}

TEST(LogWriter, RefusesWhatLcmWouldNotRead) {
  const test::ScratchFolder folder;
  LogWriter log(folder / "run.lcm");
  const Bytes bytes = encode(state_at(1us));
  for (const std::string& channel : {std::string(), std::string(1000, 'X')})
    EXPECT_THROW(log.write(channel, bytes), std::invalid_argument);
  EXPECT_THROW(log.write("X", Bytes(15)), std::invalid_argument);  // no room for a time
}

}  // namespace
}  // namespace nightjar::msg
