#include "scenarios/frame_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "scenarios/reconstruct.h"
#include "tests/support/fake_recording.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_network.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
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

  std::string error_of(const std::vector<camera::RecordingPart>& parts) {
    try {
      score_parts(parts);
    } catch (const EmptyRecording& error) {
      return error.what();
    }
    return "no error";
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
  camera::RecordingPart part;
  brighten(part, 0ms, kFirst);
  brighten(part, 100ms + 1us, kSecond);
  part.events.push_back({kEpoch + 1s, 0, 0, true});
  part.frames = {frame(100ms, {kFirst})};
  const MethodScores one = score_parts({part});
  EXPECT_NEAR(one.methods[0].score->explained, 1, 1e-9);  // two levels: the fit is exact
  part.frames = {frame(100ms + 1us, {kFirst})};           // now the second square is there, too
  EXPECT_LT(score_parts({part}).methods[0].score->explained, 0.8);
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
  EXPECT_LT(scores.methods[0].frames[1].score.explained, 0.01);
  EXPECT_NEAR(scores.methods[0].score->explained, 0.5, 0.01);
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
  EXPECT_GT(mse, 1);
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
  // As the frame before, but for the pixel that had an event.
  EXPECT_GT(scores.methods[0].frames[0].score.explained, 0.99);
  EXPECT_LT(scores.methods[0].frames[1].score.explained, 0.01);  // nothing foretold that one
  part.frames[0].exposure_end += 10ms, part.frames[0].exposure_begin -= 10ms;
  part.frames[1] = frame(44ms, {kFirst});  // before the first has ended
  choice_.from_s = 0.04;
  EXPECT_LT(score_parts({part}).methods[0].frames[0].score.explained, 0.01);
}

TEST_F(FrameScoresTest, skips_methods_that_lack_what_they_start_from) {
  options_.methods = {esi::Method::firenet, esi::Method::edi, esi::Method::esi};
  camera::RecordingPart part = scene_of(frame(100ms, {kFirst}));
  MethodScores scores = score_parts({part});
  EXPECT_EQ(scores.methods[0].skipped, "no weights: reconstructor.firenet.weights");
  EXPECT_EQ(scores.methods[1].skipped, "needs a frame before those compared");
  EXPECT_FALSE(scores.methods[0].score || scores.methods[1].score);
  EXPECT_TRUE(scores.methods[1].frames.empty());
  EXPECT_TRUE(scores.methods[2].score);
  part.frames = {frame(60ms, {kFirst}), frame(100ms, {kFirst})};
  part.frames[0].exposure_begin = part.frames[0].exposure_end = kEpoch + 60ms;
  EXPECT_THAT(score_parts({part}).methods[1].skipped,
              HasSubstr("needs frames: frame exposed from"));
}

// The tiny network's picture is v / 4 + s / 2, v the events of the step, s those of the one before.
TEST_F(FrameScoresTest, has_networks_step_so_that_a_step_ends_at_the_frame) {
  const test::ScratchFolder folder;
  options_.methods = {esi::Method::firenet};
  options_.reconstructor.firenet = {
      .weights = test::TinyNetwork{.size = kSensor}.write(folder / "tiny.onnx").string(),
      .normalise = false,
      .stretch = false};
  options_.rate_hz = 18;  // 1.8 steps to the frame: two, the first until 50 ms, not 56
  camera::RecordingPart part;
  brighten(part, 0ms, kFirst);
  brighten(part, 52ms, kSecond);
  part.events.push_back({kEpoch + 1s, 0, 0, true});
  camera::RecordedFrame shown = frame(100ms, {kFirst, kSecond});
  for (std::uint16_t& level : shown.gray.pixels()) level = level == 200 ? 100 : 0;
  in_square(kFirst, [&](int x, int y) { shown.gray(x, y) = 200; });  // s / 2 is twice v / 4
  part.frames = {shown};
  const auto explained = [&] { return score_parts({part}).methods[0].score->explained; };
  EXPECT_NEAR(explained(), 1, 1e-9);  // the levels are 128, 64 and 0: the fit is exact
  options_.rate_hz = 10;              // one step, in which all are new and alike
  EXPECT_LT(explained(), 0.95);
}

TEST_F(FrameScoresTest, says_what_is_missing) {
  EXPECT_EQ(error_of({}), "no events");
  camera::RecordingPart part = scene_of(frame(20ms, {kFirst}));
  EXPECT_EQ(error_of({part}), "0 frames compared, 1 left out: 1 too early");
  part.frames.clear();
  EXPECT_THAT(error_of({part}), HasSubstr("no frames to compare with"));
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
  options_.until_s = 0.01;  // before choice_.from_s
  EXPECT_THROW(score_parts({part}), std::invalid_argument);
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
