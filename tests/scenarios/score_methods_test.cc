#include "scenarios/score_methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "scenarios/recordings.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A square in the middle turns bright, so a good picture is that square.
class ScoreMethodsTest : public testing::Test {
 protected:
  ScoreMethodsTest() {
    for (int i = 0; i < 3; ++i)
      for (std::uint16_t y = 8; y < 16; ++y)
        for (std::uint16_t x = 8; x < 16; ++x) {
          part_.events.push_back({core::Time((i + 1) * 10000), x, y, true});
          square_(x, y) = 200;
        }
    options_.methods = {esi::Method::esi};
  }

  /// Of the square, around 70 ms.
  void add_frame() {
    camera::RecordedFrame frame;
    frame.frame_begin = frame.exposure_begin = core::Time(65000);
    frame.frame_end = frame.exposure_end = core::Time(75000);
    frame.gray = core::Image<std::uint16_t>(square_.size());
    std::ranges::copy(square_.pixels(), frame.gray.pixels().begin());
    part_.frames = {frame};
    part_.events.push_back({core::Time(90000), 0, 0, true});
  }

  std::filesystem::path write(const std::string& name) const {
    const auto writer = create_recording(folder_ / name, {.size = square_.size(), .camera = ""});
    writer->write(part_);
    writer->finish();
    return folder_ / name;
  }

  static std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  }

  std::string error_against_frames(const std::filesystem::path& path) const {
    return error_of([&] { score_against_frames(path, std::nullopt, options_, {}); });
  }

  test::ScratchFolder folder_;
  camera::RecordingPart part_;
  core::Image<std::uint8_t> square_{{24, 24}, 50};
  ScoreOptions options_;
};

TEST_F(ScoreMethodsTest, scores_a_right_picture_high_and_a_wrong_one_low) {
  const auto path = write("events.txt");
  const MethodScores right = score_against_picture(path, square_, options_);
  ASSERT_EQ(right.methods.size(), 1u);
  EXPECT_FALSE(right.frames);
  EXPECT_EQ(right.methods[0].method, "esi");
  EXPECT_NEAR(right.methods[0].score->quality.ssim, 1, 1e-9);  // two levels: the fit is exact
  EXPECT_NEAR(right.methods[0].score->explained, 1, 1e-9);
  core::Image<std::uint8_t> stripes({24, 24});
  for (int x = 0; x < 24; x += 3)
    for (int y = 0; y < 24; ++y) stripes(x, y) = 255;
  const MethodScores wrong = score_against_picture(path, stripes, options_);
  // The picture has two levels, as square_ has, and which two does not matter.
  EXPECT_NEAR(wrong.methods[0].score->quality.ssim, esi::compare(square_, stripes).ssim, 1e-9);
  // r^2 of a square of 1/9 of the pixels and stripes of 1/3, with 3/8 of the square in common.
  EXPECT_NEAR(wrong.methods[0].score->explained, 1.0 / 1024, 1e-9);
}

TEST_F(ScoreMethodsTest, says_which_methods_were_skipped_and_why) {
  options_.methods = {esi::Method::firenet, esi::Method::edi, esi::Method::esi};
  const MethodScores scores = score_against_picture(write("events.txt"), square_, options_);
  EXPECT_EQ(scores.methods[0].skipped, "no weights: reconstructor.firenet.weights");
  EXPECT_EQ(scores.methods[1].skipped, "needs frames, the recording holds none");
  EXPECT_FALSE(scores.methods[0].score || scores.methods[1].score);
  EXPECT_TRUE(scores.methods[2].score);
}

TEST_F(ScoreMethodsTest, tells_how_far_it_is_with_all_methods) {
  options_.methods = {esi::Method::esi, esi::Method::htac};
  std::vector<double> shares;
  options_.on_progress = [&](double share) { shares.push_back(share); };
  score_against_picture(write("events.txt"), square_, options_);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_THAT(shares, testing::Contains(0.5));
  EXPECT_DOUBLE_EQ(shares.back(), 1);
}

TEST_F(ScoreMethodsTest, refuses_a_reference_of_another_size) {
  const auto path = write("events.txt");
  EXPECT_THROW(score_against_picture(path, core::Image<std::uint8_t>({12, 12}), options_),
               std::invalid_argument);
}

TEST_F(ScoreMethodsTest, refuses_too_small_a_sensor_before_it_reads) {
  EXPECT_THAT(
      error_of([&] {
        score_against_picture(folder_ / "none.txt", core::Image<std::uint8_t>({40, 10}), options_);
      }),
      HasSubstr("reference of 40x10 px, allowed from 11x11"));
  square_ = core::Image<std::uint8_t>({10, 40});
  part_ = {};
  EXPECT_THAT(error_against_frames(write("thin.aedat4")),
              HasSubstr("thin.aedat4: sensor of 10x40 px, allowed from 11x11"));
}

TEST_F(ScoreMethodsTest, finds_its_references_in_every_format_that_carries_frames) {
  add_frame();
  for (const char* name : {"dark.aedat4", "dark.aedat", "dark.lcm"}) {
    const MethodScores scores = score_against_frames(write(name), std::nullopt, options_, {});
    EXPECT_EQ(scores.frames->compared, 1u) << name;
    EXPECT_EQ(scores.methods[0].frames[0].t, core::Time(70000)) << name;
    EXPECT_NEAR(scores.methods[0].score->explained, 1, 1e-9) << name;  // two levels
    EXPECT_EQ(scores.first_fault, "") << name;
  }
}

TEST_F(ScoreMethodsTest, names_the_recording_that_has_no_frames) {
  EXPECT_THAT(error_against_frames(write("events.txt")),
              AllOf(HasSubstr("events.txt: no frames"), HasSubstr("--reference")));
  EXPECT_THAT(error_against_frames(folder_ / "none.aedat4"), HasSubstr("none.aedat4: cannot be"));
}

TEST_F(ScoreMethodsTest, tells_of_damage) {
  add_frame();
  const auto path = write("dark.aedat");
  std::ofstream(path, std::ios::app | std::ios::binary) << "torn";
  EXPECT_THAT(score_against_frames(path, std::nullopt, options_, {}).first_fault,
              HasSubstr("dark.aedat: byte"));
  EXPECT_THAT(score_against_picture(path, square_, options_).first_fault,
              HasSubstr("dark.aedat: byte"));
}

}  // namespace
}  // namespace nightjar::scenarios
