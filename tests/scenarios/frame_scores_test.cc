#include "scenarios/frame_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "scenarios/reconstruct.h"
#include "tests/support/fake_recording.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_network.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

constexpr core::Resolution kSensor{24, 24};
/// Unix time, as real cameras stamp: beyond what 32 bits hold.
constexpr core::Time kEpoch{1589163147368868};

/// What lies in [left, left + 8) x [left, left + 8).
template <class Draw>
void in_square(int left, const Draw& draw) {
  for (int y = left; y < left + 8; ++y)
    for (int x = left; x < left + 8; ++x) draw(x, y);
}

/// One square turns bright when the recording begins, another one later on.
class FrameScoresTest : public testing::Test {
 protected:
  static constexpr int kFirst = 2, kSecond = 14;

  FrameScoresTest() { options_.methods = {esi::Method::esi}; }

  static void brighten(camera::RecordingPart& part, core::Time t, int square) {
    in_square(square, [&](int x, int y) {
      part.events.push_back(
          {kEpoch + t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), true});
    });
  }

  /// Exposed for 10 ms around `middle`: each square 200 levels of 255, all else 40.
  static camera::RecordedFrame frame(core::Time middle, std::initializer_list<int> squares) {
    camera::RecordedFrame frame{
        test::flat_frame(kSensor, kEpoch + middle - 5ms, kEpoch + middle + 5ms, 40)};
    for (const int square : squares)
      in_square(square, [&](int x, int y) { frame.gray(x, y) = 200; });
    return frame;
  }

  MethodScores score_parts(const std::vector<camera::RecordingPart>& parts) {
    test::FakeRecording events(kSensor, parts), frames(kSensor, parts);
    return score_frames(events, frames, options_, choice_);
  }

  static std::string error_when(const std::function<void()>& action) {
    try {
      action();
    } catch (const EmptyRecording& error) {
      return error.what();
    }
    return "no error";
  }

  std::string error_of(const std::vector<camera::RecordingPart>& parts) {
    return error_when([&] { score_parts(parts); });
  }

  /// The first square at 0 ms, then a frame of it, and an event at the end.
  static camera::RecordingPart scene_of(const camera::RecordedFrame& frame) {
    camera::RecordingPart part;
    brighten(part, 0ms, kFirst);
    part.events.push_back({kEpoch + 1s, 0, 0, true});
    part.frames = {frame};
    return part;
  }

  ScoreOptions options_;
  FrameChoice choice_;
};

TEST_F(FrameScoresTest, compares_the_picture_of_the_events_up_to_the_middle_of_the_exposure) {
  options_.reconstructor.esi.decay_rate_hz = 0;  // so that events count alike
  camera::RecordingPart part;
  brighten(part, 0ms, kFirst);
  brighten(part, 100ms + 1us, kSecond);
  part.events.push_back({kEpoch + 1s, 0, 0, true});
  part.frames = {frame(100ms, {kFirst})};
  const MethodScores one = score_parts({part});
  EXPECT_NEAR(one.methods[0].score->explained, 1, 1e-9);  // two levels: the fit is exact
  part.frames = {frame(100ms + 1us, {kFirst})};           // now the second square is there, too
  // r^2 of two squares of 1/9 of the pixels each and one of them.
  EXPECT_NEAR(score_parts({part}).methods[0].score->explained, 7.0 / 16, 1e-9);
  EXPECT_EQ(one.frames->compared, 1u);
  EXPECT_THAT(one.methods[0].frames, testing::SizeIs(1));
  EXPECT_EQ(one.methods[0].frames[0].t, kEpoch + 100ms);
}

TEST_F(FrameScoresTest, compares_each_frame_however_late_it_is_in_the_file) {
  camera::RecordingPart first, second;
  brighten(first, 0ms, kFirst);
  brighten(first, 120ms, kSecond);
  brighten(first, 120ms, kFirst);
  brighten(first, 300ms, kSecond);
  second.frames = {frame(100ms, {kFirst}), frame(200ms, {})};
  second.frames[1].gray(0, 0) = 255;  // unlike what the picture shows
  const MethodScores scores = score_parts({first, second});
  ASSERT_EQ(scores.methods[0].frames.size(), 2u);
  EXPECT_NEAR(scores.methods[0].frames[0].score.explained, 1, 1e-9);  // two levels
  EXPECT_NEAR(scores.methods[0].frames[1].score.explained, 0, 1e-9);
  EXPECT_NEAR(scores.methods[0].score->explained, 0.5, 1e-9);
}

TEST_F(FrameScoresTest, leaves_out_the_first_frames_and_those_exposed_for_long) {
  camera::RecordingPart part = scene_of(frame(50ms - 1us, {kFirst}));
  part.frames.push_back(frame(50ms, {kFirst}));
  part.frames.push_back(frame(100ms, {kFirst}));
  part.frames.back().exposure_end += 40ms + 1us;  // 50 ms are allowed
  part.frames.push_back(frame(200ms, {kFirst}));
  part.frames.back().exposure_end += 40ms;
  const FrameCount count = score_parts({part}).frames.value();
  EXPECT_EQ(count.compared, 2u);
  EXPECT_EQ(count.too_early, 1u);
  EXPECT_EQ(count.exposed_too_long, 1u);
  choice_ = {.from_s = 0, .max_exposure_ms = 51};
  EXPECT_EQ(score_parts({part}).frames->compared, 4u);
  options_.until_s = 0.1;
  EXPECT_EQ(score_parts({part}).frames->compared, 2u);
}

TEST_F(FrameScoresTest, leaves_out_frames_that_cannot_be_compared) {
  camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  part.frames.push_back(frame(200ms, {}));  // of one grey level
  camera::RecordedFrame piece{test::flat_frame({12, 12}, kEpoch + 300ms, kEpoch + 310ms, 9)};
  piece.gray(0, 0) = 99;
  part.frames.push_back(piece);
  part.frames.push_back(frame(1s, {kFirst}));  // nothing has happened since, or nothing is told
  const FrameCount count = score_parts({part}).frames.value();
  EXPECT_EQ(count.compared, 1u);
  EXPECT_EQ(count.unfit, 2u);
  EXPECT_EQ(count.after_events, 1u);
}

TEST_F(FrameScoresTest, brings_frames_of_more_bits_to_eight) {
  camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  brighten(part, 1s, kSecond);
  part.frames[0].gray(20, 20) = 90;
  const double mse = score_parts({part}).methods[0].score->quality.mse;
  for (std::uint16_t& level : part.frames[0].gray.pixels())
    level = static_cast<std::uint16_t>(level << 2 | 3);
  part.frames[0].bits = 10;
  EXPECT_DOUBLE_EQ(score_parts({part}).methods[0].score->quality.mse, mse);
  EXPECT_NEAR(mse, 50 * 50 * (1 - 1.0 / 512) / 576, 1e-9);  // of one pixel among 512 dark ones
}

TEST_F(FrameScoresTest, gives_methods_the_frames_that_have_ended_and_never_the_one_compared) {
  options_.methods = {esi::Method::edi, esi::Method::esi};
  camera::RecordingPart part;
  part.events = {{kEpoch, 0, 0, true}, {kEpoch + 1s, 0, 0, false}};
  part.frames = {frame(30ms, {kFirst}), frame(100ms, {kFirst}), frame(200ms, {kSecond})};
  const MethodScores scores = score_parts({part});
  EXPECT_TRUE(scores.methods[0].saw_frames);
  EXPECT_FALSE(scores.methods[1].saw_frames);
  ASSERT_EQ(scores.methods[0].frames.size(), 2u);
  EXPECT_NEAR(scores.methods[0].frames[0].score.explained, 1, 1e-9);  // as the frame before
  EXPECT_NEAR(scores.methods[0].frames[1].score.explained, 0, 1e-9);  // nothing foretold that one
  part.frames[0].exposure_end += 10ms, part.frames[0].exposure_begin -= 10ms;
  part.frames[1] = frame(44ms, {kFirst});  // before the first has ended
  choice_.from_s = 0.04;
  EXPECT_NEAR(score_parts({part}).methods[0].frames[0].score.explained, 0, 1e-9);
}

TEST_F(FrameScoresTest, skips_methods_that_lack_what_they_start_from) {
  options_.methods = {esi::Method::firenet, esi::Method::edi, esi::Method::esi};
  camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  MethodScores scores = score_parts({part});
  EXPECT_EQ(scores.methods[0].skipped, "no weights: reconstructor.firenet.weights");
  EXPECT_EQ(scores.methods[1].skipped, "needs a frame before the last one compared");
  EXPECT_FALSE(scores.methods[0].score || scores.methods[1].score);
  EXPECT_TRUE(scores.methods[1].frames.empty());
  EXPECT_TRUE(scores.methods[2].score);
  part.frames = {frame(60ms, {kFirst}), frame(100ms, {kFirst})};
  part.frames[0].exposure_begin = part.frames[0].exposure_end = kEpoch + 60ms;
  EXPECT_THAT(score_parts({part}).methods[1].skipped,
              HasSubstr("needs frames: frame exposed from"));
}

/// Whose picture is v / 4 + s / 2, v the events of the step, s those of the one before.
class NetworkScoresTest : public FrameScoresTest {
 protected:
  NetworkScoresTest() {
    options_.methods = {esi::Method::firenet};
    options_.reconstructor.firenet = {
        .weights = test::TinyNetwork{.size = kSensor}.write(folder_ / "tiny.onnx").string(),
        .normalise = false,
        .stretch = false};
  }

  /// The first square at 0 ms, the second at 52 ms, `frames`, and one at 100 ms in which the
  /// first is twice as bright as the second, as s / 2 is twice v / 4.
  double explained(std::vector<camera::RecordedFrame> frames) {
    camera::RecordingPart part;
    brighten(part, 0ms, kFirst);
    brighten(part, 52ms, kSecond);
    part.events.push_back({kEpoch + 1s, 0, 0, true});
    camera::RecordedFrame shown = frame(100ms, {kFirst, kSecond});
    for (std::uint16_t& level : shown.gray.pixels()) level = level == 200 ? 100 : 0;
    in_square(kFirst, [&](int x, int y) { shown.gray(x, y) = 200; });
    frames.push_back(shown);
    part.frames = frames;
    return score_parts({part}).methods[0].frames.at(0).score.explained;
  }

  // Levels of 128, 64 and 0: the fit is exact.
  static constexpr double kTwoSteps = 1;
  // Both squares are new and alike, each of 1/9 of the pixels: of the reference's variance
  // (200^2 + 100^2) / 9 - (300 / 9)^2 = 40000 / 9 there remains 2 50^2 / 9, its eighth.
  static constexpr double kOneStep = 7.0 / 8;

  test::ScratchFolder folder_;
};

TEST_F(NetworkScoresTest, have_a_step_end_at_the_frame) {
  options_.rate_hz = 18;  // 1.8 steps to the frame: two, the first until 50 ms, not 56
  EXPECT_NEAR(explained({}), kTwoSteps, 1e-9);
  options_.rate_hz = 10;
  EXPECT_NEAR(explained({}), kOneStep, 1e-9);
}

TEST_F(NetworkScoresTest, have_a_step_end_at_a_frame_that_is_left_out) {
  options_.rate_hz = 10;
  EXPECT_NEAR(explained({frame(40ms, {kFirst})}), kTwoSteps, 1e-9);  // too early
}

TEST_F(FrameScoresTest, says_what_is_missing) {
  EXPECT_EQ(error_of({}), "no events");
  camera::RecordingPart part = scene_of(frame(20ms, {kFirst}));
  EXPECT_EQ(error_of({part}), "0 frames compared, 1 left out: 1 too early");
  part.frames.clear();
  EXPECT_THAT(error_of({part}), HasSubstr("no frames to compare with"));
}

TEST_F(FrameScoresTest, says_that_frames_were_exposed_for_too_long_and_what_takes_them) {
  camera::RecordingPart part = scene_of(frame(300ms, {kFirst}));
  part.frames[0].exposure_begin = kEpoch + 50ms;
  part.frames[0].exposure_end = kEpoch + 550ms;  // as at 5 lux
  EXPECT_EQ(error_of({part}),
            "0 frames compared, 1 left out: 1 exposed for too long; a --max-exposure over 50 ms "
            "takes those");
  choice_.max_exposure_ms = 500;
  EXPECT_EQ(error_of({part}), "no error");
}

TEST_F(FrameScoresTest, says_that_the_frames_come_after_the_end) {
  const camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  options_.until_s = 0.0999;
  EXPECT_EQ(error_of({part}), "0 frames compared; frames after --until 0.0999 are not counted");
  options_.until_s = 0.1;
  EXPECT_EQ(error_of({part}), "no error");
}

TEST_F(FrameScoresTest, tells_of_damage_where_there_is_nothing_to_compare) {
  const auto error = [&](const std::vector<camera::RecordingPart>& parts, bool in_events) {
    test::FakeRecording events(kSensor, parts), frames(kSensor, parts);
    (in_events ? events : frames).faults_.first = "torn.aedat4: byte 9: torn";
    return error_when([&] { score_frames(events, frames, options_, choice_); });
  };
  EXPECT_EQ(error({}, true), "no events; torn.aedat4: byte 9: torn");
  camera::RecordingPart part = scene_of(frame(20ms, {kFirst}));
  EXPECT_THAT(error({part}, false), EndsWith("1 too early; torn.aedat4: byte 9: torn"));
  part.frames.clear();
  EXPECT_THAT(error({part}, false), EndsWith("takes another; torn.aedat4: byte 9: torn"));
}

TEST_F(FrameScoresTest, refuses_a_sensor_smaller_than_the_window_of_the_comparison) {
  test::FakeRecording events({10, 40}, {}), frames({10, 40}, {});
  EXPECT_EQ(error_when([&] { score_frames(events, frames, options_, choice_); }),
            "sensor of 10x40 px, allowed from 11x11 px");
}

TEST_F(FrameScoresTest, refuses_options_out_of_range) {
  const camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  choice_.from_s = -1;
  EXPECT_THROW(score_parts({part}), std::invalid_argument);
  choice_ = {.max_exposure_ms = 0};
  EXPECT_THROW(score_parts({part}), std::invalid_argument);
  choice_ = {};
  options_.rate_hz = 0;
  EXPECT_THROW(score_parts({part}), std::invalid_argument);
  options_.rate_hz = 100;
  options_.until_s = -1;
  EXPECT_THROW(score_parts({part}), std::invalid_argument);
  options_.until_s = 0.01;
  try {
    score_parts({part});
    ADD_FAILURE() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "until_s = 0.01, allowed from_s (--from) = 0.05 to 1000000000");
  }
}

TEST_F(FrameScoresTest, tells_how_far_it_is_and_can_be_stopped) {
  camera::RecordingPart first = scene_of(frame(100ms, {kFirst})), second;
  second.events = {{kEpoch + 3s, 1, 1, true}, {kEpoch + 4s, 1, 1, true}};
  second.frames = {frame(2s, {kFirst})};
  std::vector<double> shares;
  options_.on_progress = [&](double share) { shares.push_back(share); };
  score_parts({first, second});
  // Each part of frames, and the events up to each: half the file is 1 s, so all is 2 s.
  EXPECT_THAT(shares, ElementsAre(0, 0, 0.05, 0.5));
  struct Stop {};
  options_.on_progress = [](double) { throw Stop(); };
  EXPECT_THROW(score_parts({first, second}), Stop);
}

}  // namespace
}  // namespace nightjar::scenarios
