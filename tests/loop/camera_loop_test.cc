// A camera's packets, played by a double behind libcaer's thin layer, through the processes
// that fly: source, reconstruction and tracker, on one bus.

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "camera/caer_camera.h"
#include "msg/log_reader.h"
#include "scenarios/loop.h"
#include "scenarios/output_folder.h"
#include "scenarios/processes.h"
#include "scenarios/send_camera.h"
#include "tests/support/camera_caer_double.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using core::Time;

Scenario smoke() { return load(NIGHTJAR_SOURCE_DIR "/scenarios/smoke.yaml"); }

/// What the simulator's camera saw and its autopilot knew in a short flight, and what
/// came of it there.
struct Flight {
  std::vector<core::EventPacket> packets;
  std::vector<core::VehicleState> states;
  std::map<Time, core::TargetEstimate> estimates;
  std::map<Time, core::Truth> truth;
};

Flight fly() {
  const test::ScratchFolder folder;
  Scenario scenario = smoke();
  scenario.duration_s = 1.8;
  RunOptions options;
  options.out = folder.path() / "out";
  options.video = false;
  options.record_events = true;
  run(scenario, options);
  Flight flight;
  msg::LogReader log(options.out / kLogFile);
  while (const auto message = log.next()) {
    const auto is = [&](const auto& channel) { return message->channel == channel.name; };
    if (is(msg::kEvents))
      flight.packets.push_back(msg::decode<core::EventPacket>(message->bytes));
    else if (is(msg::kVehicleState))
      flight.states.push_back(msg::decode<core::VehicleState>(message->bytes));
    else if (is(msg::kTargetEstimate)) {
      const auto estimate = msg::decode<core::TargetEstimate>(message->bytes);
      flight.estimates[estimate.t] = estimate;
    } else if (is(msg::kTruth)) {
      const auto truth = msg::decode<core::Truth>(message->bytes);
      flight.truth[truth.t] = truth;
    }
  }
  return flight;
}

const Flight& flight() {
  static const Flight flight = fly();
  return flight;
}

/// The packet as the camera would hand it over when its clock is `ahead` of the flight's,
/// with inertial samples at its very begin and end, so that it spans the same time.
test::CaerDoubleContainer container(const core::EventPacket& packet, Time ahead) {
  constexpr std::int64_t kWrap_us = std::int64_t{1} << 31;
  test::CaerDoubleContainer container;
  std::map<int, std::pair<int, std::string>> events;  // by the count of wraps
  for (const core::Event& e : packet.events) {
    const std::int64_t t_us = (e.t + ahead).count();
    auto& [number, bytes] = events[static_cast<int>(t_us / kWrap_us)];
    ++number;
    bytes += test::caer_polarity(e.x, e.y, e.on, static_cast<std::int32_t>(t_us % kWrap_us));
  }
  for (const auto& [wraps, packed] : events)
    container.packets.push_back(test::caer_packet(1, 8, wraps, packed.first, packed.second));
  for (const Time t : {packet.begin + Time(1), packet.end}) {
    const std::int64_t t_us = (t + ahead).count();
    container.packets.push_back(
        test::caer_packet(3, 36, static_cast<int>(t_us / kWrap_us), 1,
                          test::caer_imu6(static_cast<std::int32_t>(t_us % kWrap_us))));
  }
  container.host_time = packet.end;
  return container;
}

/// A camera beside which a bridge to an autopilot sends the vehicle's states, in the
/// camera's time.
class BridgedCamera : public camera::EventSource {
 public:
  BridgedCamera(camera::EventSource& camera, msg::Bus& wire, Time ahead)
      : camera_(camera), wire_(wire), ahead_(ahead) {}

  std::string name() const override { return camera_.name(); }
  core::Resolution size() const override { return camera_.size(); }
  void start() override { camera_.start(); }
  void stop() override { camera_.stop(); }
  camera::SourceCounts counts() const override { return camera_.counts(); }
  camera::Arrival next(camera::LivePacket& packet) override {
    const camera::Arrival arrival = camera_.next(packet);
    for (; arrival == camera::Arrival::packet && sent_ < flight().states.size(); ++sent_) {
      core::VehicleState state = flight().states[sent_];
      state.t += ahead_;
      if (state.t > packet.end) break;
      wire_.publish(msg::kVehicleState, state);
    }
    return arrival;
  }

 private:
  camera::EventSource& camera_;
  msg::Bus& wire_;
  Time ahead_;
  std::size_t sent_ = 0;
};

class CameraLoopTest : public testing::Test {
 protected:
  // The camera's 31 bits of microseconds wrap 0.6 s into the flight.
  static constexpr Time kAhead = Time(std::int64_t{1} << 31) - 600ms;

  /// Plays the sessions until the last one is silent.
  void play(std::vector<test::CaerDoubleSession> sessions) {
    const auto all = sessions.size();
    test::CaerDouble bench(std::move(sessions));
    bench.silence_times_out = true;
    camera::CaerConfig config;
    config.reconnect.first_pause_ms = config.reconnect.most_pause_ms = 1.0;
    camera::CaerCamera camera(config, bench.opener(), [&] { return bench.now(); });
    BridgedCamera bridged(camera, wire_, kAhead);
    wire_.subscribe(msg::kTargetEstimate, [this](const auto& e) { estimates_[e.t - kAhead] = e; });
    wire_.subscribe(msg::kAttitudeSetpoint, [this](const auto& s) { setpoints_.push_back(s); });
    std::uint64_t packets = 0;
    const auto others = [&] {
      reconstruct_.serve(0ms);
      track_.serve(0ms);
      wire_.dispatch();
      const bool silent =
          camera.counts().packets == std::exchange(packets, camera.counts().packets);
      if (silent && bench.opened == static_cast<int>(all)) camera.stop();
    };
    SourceLink link(wire_, std::nullopt, {.lock_step = false, .while_waiting = others});
    send_camera(bridged, link);
    source_ = link.meter().report();
  }

  static std::vector<test::CaerDoubleContainer> containers(Time from, Time to, Time ahead) {
    std::vector<test::CaerDoubleContainer> list;
    for (const core::EventPacket& packet : flight().packets)
      if (packet.end > from && packet.end <= to) list.push_back(container(packet, ahead));
    return list;
  }

  static Scenario real() {
    Scenario scenario = smoke();
    scenario.source.type = camera::SourceType::caer;
    scenario.model.clear();
    return scenario;
  }

  /// Horizontal and vertical error of the estimate for the flight's time `t`.
  double error_m(Time t) const {
    const auto found = estimates_.find(t);
    if (found == estimates_.end() || !found->second.valid)
      return std::numeric_limits<double>::infinity();
    return (found->second.p_world_tag_m - flight().truth.at(t).T_world_tag.translation()).norm();
  }

  msg::Bus wire_;
  std::string estimates_sha256_;
  NodeProcess reconstruct_{
      wire_, reconstruction_process(smoke().reconstructor, camera::CaerCamera::kSize)};
  NodeProcess track_{wire_, tracker_process(real(), estimates_sha256_)};
  std::map<Time, core::TargetEstimate> estimates_;  // by the flight's time
  std::vector<core::AttitudeSetpoint> setpoints_;
  ProcessReport source_;
};

TEST_F(CameraLoopTest, EstimatesWhatTheSimulatorsLoopDidAcrossTheWrapOfTheClock) {
  play({{.containers = containers(0ms, 1800ms, kAhead)}});
  EXPECT_EQ(source_.steps, 180u);
  ASSERT_EQ(setpoints_.size(), 180u);
  ASSERT_TRUE(flight().estimates.at(590ms).valid);
  for (const auto& [t, wanted] : flight().estimates) {
    ASSERT_EQ(estimates_.count(t), 1u) << t.count();
    const core::TargetEstimate& got = estimates_.at(t);
    ASSERT_EQ(got.valid, wanted.valid) << t.count();
    // The same but for the camera's place, which comes from other arithmetic: 1e-12 m there.
    EXPECT_LT((got.p_world_tag_m - wanted.p_world_tag_m).norm(), 1e-6) << t.count();
  }
  ASSERT_TRUE(source_.camera);
  EXPECT_EQ(source_.camera->counts.imu, 2 * 180u);
  EXPECT_FALSE(source_.camera->counts.any_loss());
}

TEST_F(CameraLoopTest, IsSilentWhileTheCameraIsAwayAndFindsTheTagAgain) {
  auto before = containers(0ms, 700ms, kAhead);
  before.erase(before.begin() + 50, before.begin() + 52);  // the buffer was full
  before[50].lost_before = 2;
  play({{.containers = std::move(before), .unplugged_then = true},
        {.failures_before = 2, .containers = containers(900ms, 1800ms, -890ms)}});
  EXPECT_EQ(source_.steps, 70u - 2u + 90u);
  EXPECT_EQ(setpoints_.size(), 70u - 2u + 90u);
  EXPECT_EQ(source_.camera->name, "DAVIS346 00000123");
  EXPECT_TRUE(source_.camera->connected);
  EXPECT_EQ(source_.camera->counts.packets_lost, 2u);
  EXPECT_EQ(source_.camera->counts.disconnects, 1u);
  EXPECT_EQ(source_.camera->counts.reconnects, 1u);
  for (const auto& [t, estimate] : estimates_) EXPECT_TRUE(t <= 700ms || t > 900ms) << t.count();
  EXPECT_EQ(track_.meter().report().refused, 0u);
  // Ten times the filter's standard deviation of a fix at 0.9 m, with motion in between.
  for (const Time t : {700ms, 1800ms}) EXPECT_LT(error_m(t), 0.05) << t.count();
  const core::TargetEstimate& last = estimates_.at(1800ms);
  EXPECT_GE(last.last_tag - kAhead, Time(910ms));  // seen anew, not coasted
}

}  // namespace
}  // namespace nightjar::scenarios
