#include "scenarios/reconstruction_speed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "scenarios/reconstruction_speed_text.h"

// How fast anything is depends on the machine: what is tested is that all is measured.

namespace nightjar::scenarios {
namespace {

EventWorkload small() { return make_workload(EventPattern::uniform, 1e6, 30'000, /*seed=*/1); }

SpeedOptions options_of(std::vector<esi::Method> methods) {
  SpeedOptions options;
  options.methods = std::move(methods);
  options.rounds = 1;
  return options;
}

class CountingSubject final : public SpeedSubject {
 public:
  void restart() override { events = pictures = frames = 0; }
  void take(std::span<const esi::PackedEvent> more) override { events += more.size(); }
  void draw(core::Time) override { ++pictures; }
  bool takes_frames() const override { return wants_frames; }
  void take_frame(core::ApsFrame frame) override {
    ++frames;
    last_frame = std::move(frame);
  }

  bool wants_frames = true;
  std::size_t events = 0, pictures = 0, frames = 0;
  core::ApsFrame last_frame;
};

TEST(ReconstructionSpeedTest, a_subject_gets_every_event_and_a_picture_after_every_packet) {
  const EventWorkload w = make_workload(EventPattern::uniform, 1e6, 100'000, /*seed=*/1);
  CountingSubject subject;
  EXPECT_GT(measure_rate_hz(subject, w, true, 1e9), 0);
  EXPECT_EQ(subject.events, w.events.size());
  EXPECT_EQ(subject.pictures, w.packet_ends.size());
  ASSERT_GT(w.frames.size(), 0u);
  EXPECT_EQ(subject.frames, w.frames.size());
  EXPECT_EQ(subject.last_frame.exposure_end, w.frames.back().exposure_end);
  EXPECT_TRUE(std::ranges::equal(subject.last_frame.gray.pixels(), w.frames.back().gray.pixels()));
  measure_rate_hz(subject, w, false, 1e9);
  EXPECT_EQ(subject.pictures, 0u);
}

TEST(ReconstructionSpeedTest, a_subject_gets_no_frame_it_does_not_take) {
  CountingSubject subject;
  subject.wants_frames = false;
  measure_rate_hz(subject, make_workload(EventPattern::uniform, 1e6, 100'000, /*seed=*/1), false,
                  1e9);
  EXPECT_EQ(subject.events, 100'000u);
  EXPECT_EQ(subject.frames, 0u);
}

TEST(ReconstructionSpeedTest, a_slow_subject_is_stopped) {
  const EventWorkload w = small();
  CountingSubject subject;
  measure_rate_hz(subject, w, true, 0);
  EXPECT_EQ(subject.pictures, 1u);
}

TEST(ReconstructionSpeedTest, the_reference_comes_first_and_the_bound_last) {
  const WorkloadSpeed speed =
      measure_speed(small(), options_of({esi::Method::esi, esi::Method::accumulator}));
  std::vector<std::string> names;
  for (const MethodSpeed& m : speed.methods) {
    names.push_back(m.method);
    EXPECT_GT(m.events_hz, 0) << m.method;
    EXPECT_EQ(m.with_pictures_hz > 0, m.method != "bound");
  }
  EXPECT_EQ(names, (std::vector<std::string>{"esi in doubles, std::pow", "esi",
                                             "esi, 16-byte events", "accumulator", "bound"}));
}

TEST(ReconstructionSpeedTest, progress_rises_and_may_end_it) {
  SpeedOptions options = options_of({esi::Method::accumulator});
  double last = -1;
  options.on_progress = [&](double share) {
    EXPECT_GT(share, last);
    EXPECT_LT(share, 1);
    last = share;
  };
  measure_speed(small(), options);
  EXPECT_GT(last, 0);
  options.on_progress = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW(measure_speed(small(), options), std::runtime_error);
}

TEST(ReconstructionSpeedTest, times_of_pictures_leave_out_rates_that_are_too_slow) {
  const auto times = measure_picture_times(small(), options_of({esi::Method::esi}));  // 30 ms
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].method, "esi");
  std::vector<double> rates_hz;
  for (const PictureTime& t : times[0].times) {
    rates_hz.push_back(t.rate_hz);
    EXPECT_GT(t.time_s, 0);
  }
  EXPECT_EQ(rates_hz, picture_rates_hz());  // 50 Hz is 20 ms
  const auto shorter = make_workload(EventPattern::uniform, 1e6, 15'000, /*seed=*/1);
  EXPECT_EQ(measure_picture_times(shorter, options_of({esi::Method::esi}))[0].times[0].rate_hz,
            100);
}

TEST(ReconstructionSpeedTest, tables_and_json_tell_ratios) {
  const std::vector<WorkloadSpeed> speeds = {
      {"waves", 1000, {{"reference", 2e7, 1e7}, {"esi", 3e8, 2.5e8}, {"bound", 5e8, 0}}}};
  const std::string table = to_table(speeds);
  for (const char* part : {"waves", "300.0", "15.00", "0.60", "250.0", "25.00", "0.50"})
    EXPECT_NE(table.find(part), std::string::npos) << part << '\n' << table;
  const std::vector<MethodPictureTimes> times = {{"esi", {{100, 0.0002}}}};
  EXPECT_NE(to_table(times).find("0.200"), std::string::npos) << to_table(times);
  const auto json = nlohmann::json::parse(to_json(speeds, times));
  EXPECT_EQ(json["workloads"][0]["methods"][1]["times_reference"], 15.0);
  EXPECT_EQ(json["workloads"][0]["methods"][1]["share_of_bound"], 0.6);
  EXPECT_TRUE(json["workloads"][0]["methods"][2]["with_pictures_hz"].is_null());
  EXPECT_EQ(json["picture_times"][0]["times"][0]["pictures_hz"], 100);
}

TEST(ReconstructionSpeedTest, times_of_pictures_are_drawn) {
  const std::vector<MethodPictureTimes> times = {{"esi", {{50, 0.0003}, {100, 0.0002}}},
                                                 {"it's", {{100, 0.002}}}};
  EXPECT_EQ(draw_picture_times("waves", times).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace nightjar::scenarios
