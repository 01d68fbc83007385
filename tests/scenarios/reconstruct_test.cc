#include "scenarios/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "esi/esi.h"
#include "tests/support/events.h"
#include "tests/support/fake_recording.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr core::Resolution kSensor{16, 12};
/// Unix time, as real cameras stamp: beyond what 32 bits hold.
constexpr core::Time kEpoch{1589163147368868};

class ReconstructTest : public testing::Test {
 protected:
  Reconstruction run(std::vector<camera::RecordingPart> parts) {
    test::FakeRecording recording(kSensor, std::move(parts));
    recording.faults_ = faults_;
    pictures_.clear();
    return reconstruct(recording, options_, [this](const core::Picture& picture, auto) {
      pictures_.push_back(picture);
    });
  }

  Reconstruction run_times(std::initializer_list<core::Time> times) {
    return run({part(at(times))});
  }

  static camera::RecordingPart part(std::vector<core::Event> events,
                                    const std::vector<core::ApsFrame>& frames = {}) {
    camera::RecordingPart part;
    part.events = std::move(events);
    for (const core::ApsFrame& frame : frames) part.frames.push_back({frame});
    return part;
  }

  static std::vector<core::Event> at(std::initializer_list<core::Time> times) {
    std::vector<core::Event> events;
    for (const core::Time t : times) events.push_back({t, 3, 4, true});
    return events;
  }

  std::vector<core::Time> times() const {
    std::vector<core::Time> out;
    for (const core::Picture& picture : pictures_) out.push_back(picture.t);
    return out;
  }

  ReconstructOptions options_;
  camera::RecordingFaults faults_;
  std::vector<core::Picture> pictures_;
};

TEST_F(ReconstructTest, makes_a_picture_every_interval_from_the_first_event_to_the_last) {
  const Reconstruction result = run_times({kEpoch, kEpoch + 12ms, kEpoch + 30ms});
  EXPECT_THAT(times(), ElementsAre(kEpoch + 10ms, kEpoch + 20ms, kEpoch + 30ms));
  EXPECT_EQ(result.pictures, 3u);
  EXPECT_EQ(result.events, 3u);
  EXPECT_EQ(result.begin, kEpoch);
  EXPECT_EQ(result.end, kEpoch + 30ms);
  EXPECT_NEAR(result.duration_s(), 0.03, 1e-12);
  run_times({1ms, 30ms + 999us});
  EXPECT_THAT(times(), ElementsAre(11ms, 21ms));
}

TEST_F(ReconstructTest, spaces_pictures_without_drift) {
  options_.rate_hz = 300;
  run_times({0us, 1s});
  ASSERT_EQ(pictures_.size(), 300u);
  EXPECT_EQ(pictures_[0].t, 3333us);
  EXPECT_EQ(pictures_[1].t, 6667us);
  EXPECT_EQ(pictures_[299].t, 1s);
}

TEST_F(ReconstructTest, draws_what_the_method_draws_however_the_recording_is_cut) {
  auto events = test::random_events(kSensor, 5000, 1s, /*seed=*/4);
  for (core::Event& e : events) e.t += kEpoch;
  run({part(events)});
  const auto whole = pictures_;
  std::vector<camera::RecordingPart> parts;
  for (const core::Event& e : events) {
    parts.push_back(part({e}));
    parts.emplace_back();  // with nothing in it
  }
  run(parts);
  ASSERT_EQ(pictures_.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    esi::Esi plain({}, kSensor);
    plain.reset(events.front().t);
    for (const core::Event& e : events)
      if (e.t <= whole[i].t) plain.process({&e, 1});
    core::Picture wanted;
    plain.render(whole[i].t, wanted);
    ASSERT_EQ(whole[i].gray, wanted.gray) << i;
    ASSERT_EQ(pictures_[i].gray, wanted.gray) << i;
  }
}

TEST_F(ReconstructTest, leaves_pictures_out_where_nothing_happens_for_over_a_minute) {
  options_.rate_hz = 1;
  const Reconstruction jump = run_times({0s, 1000000s, 1000001s});
  EXPECT_THAT(times(), ElementsAre(1000000s, 1000001s));
  EXPECT_EQ(jump.pictures_left_out, 999999u);
  EXPECT_THAT(warning(jump), HasSubstr("999999 pictures left out"));
  EXPECT_EQ(run({part(at({0s})), part(at({1000000s, 1000001s}))}).pictures_left_out, 999999u);
  EXPECT_EQ(run_times({0s, 60s}).pictures, 60u);
}

TEST_F(ReconstructTest, keeps_to_the_window) {
  options_.from_s = 0.02;
  options_.until_s = 0.05;
  const auto result =
      run({part(at({kEpoch, kEpoch + 10ms})),
           part(at({kEpoch + 25ms, kEpoch + 49ms, kEpoch + 60ms})), part(at({kEpoch + 90ms}))});
  EXPECT_THAT(times(), ElementsAre(kEpoch + 30ms, kEpoch + 40ms, kEpoch + 50ms));
  EXPECT_EQ(result.events, 2u);
  EXPECT_EQ(result.begin, kEpoch + 20ms);
  EXPECT_EQ(result.end, kEpoch + 50ms);
}

TEST_F(ReconstructTest, gives_the_picture_at_the_end_whether_one_was_due_or_not) {
  const Reconstruction result = run_times({0ms, 15ms});
  EXPECT_EQ(result.last.t, 15ms);
  EXPECT_NE(result.last.gray, pictures_.back().gray);
  const Reconstruction brief = run_times({0ms, 5ms});
  EXPECT_EQ(brief.pictures, 0u);
  EXPECT_EQ(brief.last.t, 5ms);
  EXPECT_THAT(warning(brief), HasSubstr("no picture was due: the recording takes 0.005 s"));
}

TEST_F(ReconstructTest, hands_frames_to_the_methods_that_use_them) {
  options_.reconstructor.method = esi::Method::complementary_filter;
  const auto dark = test::flat_frame(kSensor, 1ms, 2ms, 10),
             bright = test::flat_frame(kSensor, 1ms, 2ms, 240);
  const auto unfit = test::flat_frame({2, 2}, 6ms, 7ms, 9);
  const auto with = [&](const core::ApsFrame& frame) {
    return run({part({}, {frame}), part(at({5ms, 15ms, 900ms}), {unfit})});
  };
  const Reconstruction a = with(dark);
  const Reconstruction b = with(bright);
  EXPECT_EQ(a.frames, 1u);
  EXPECT_EQ(a.frames_refused, 1u);
  EXPECT_THAT(warning(a), HasSubstr("1 frames left out, the first for: frame of 2x2"));
  EXPECT_GT(b.last.gray(0, 0), a.last.gray(0, 0));
  options_.reconstructor.method = esi::Method::esi;  // does not look at them
  EXPECT_EQ(with(dark).frames_refused, 0u);
}

TEST_F(ReconstructTest, tells_what_of_the_recording_could_not_be_used) {
  faults_.events_backwards = 7;
  faults_.first = "a.aedat: byte 12: older than its predecessor";
  const Reconstruction result = run_times({0ms, 20ms});
  EXPECT_THAT(warning(result), HasSubstr("7 running backwards"));
  EXPECT_THAT(warning(result), HasSubstr("first: a.aedat: byte 12"));
  EXPECT_EQ(nlohmann::json::parse(to_json(result))["events_backwards"], 7);
  faults_ = {};
  EXPECT_EQ(warning(run_times({0ms, 20ms})), "");
}

TEST_F(ReconstructTest, finds_no_tags_where_there_are_none_and_says_that_it_looked) {
  options_.detector.emplace();
  const Reconstruction result = run_times({0ms, 20ms});
  EXPECT_TRUE(result.searched);
  EXPECT_EQ(result.tags, 0u);
  EXPECT_THAT(to_table(result), HasSubstr("0 in 0 of 2 pictures (0.0 %)"));
  EXPECT_EQ(nlohmann::json::parse(to_json(result))["detection_rate"], 0.0);
}

TEST_F(ReconstructTest, reports_progress_and_stops_where_that_throws) {
  struct Stop {};
  double last_done_s = 0, last_end_s = 0;
  options_.on_progress = [&](double done_s, double end_s) {
    EXPECT_GE(done_s, last_done_s);
    last_done_s = done_s;
    last_end_s = end_s;
  };
  run_times({0ms, 15ms, 35ms});
  EXPECT_NEAR(last_done_s, 0.035, 1e-9);
  EXPECT_NEAR(last_end_s, 0.035, 1e-9);
  options_.on_progress = [](double, double) { throw Stop(); };
  EXPECT_THROW(run_times({0ms, 15ms, 35ms}), Stop);
}

TEST_F(ReconstructTest, refuses_what_it_cannot_work_with) {
  const auto complaint = [this](std::vector<camera::RecordingPart> parts) -> std::string {
    try {
      run(std::move(parts));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  const std::vector<camera::RecordingPart> sound = {part(at({0ms, 20ms}))};
  EXPECT_EQ(complaint({}), "no events");
  options_.rate_hz = 0;
  EXPECT_EQ(complaint(sound), "fps = 0, allowed 0.01 to 100000");
  options_ = {};
  options_.from_s = 3;
  EXPECT_EQ(complaint(sound), "no events between --from and --until");
  options_.until_s = 2;
  EXPECT_THAT(complaint(sound), HasSubstr("until_s = 2, allowed 3 to"));
  options_ = {};
  options_.reconstructor.method = esi::Method::firenet;
  EXPECT_THAT(complaint(sound), HasSubstr("firenet needs weights"));
}

}  // namespace
}  // namespace nightjar::scenarios
