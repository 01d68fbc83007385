#include "scenarios/method_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;
using testing::Not;

using Picture = core::Image<std::uint8_t>;

/// Grey, with the left half at `left`.
Picture halves(std::uint8_t left, std::uint8_t right) {
  Picture picture({12, 12}, right);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 6; ++x) picture(x, y) = left;
  return picture;
}

Score number(double value) {
  return {{.gain = value,
           .offset_levels = -value,
           .mse = 10 * value,
           .psnr_db = 20 * value,
           .ssim = value / 10},
          value / 5};
}

TEST(MethodScores, the_share_explained_is_of_the_references_variance) {
  EXPECT_DOUBLE_EQ(variance(halves(10, 30)), 100);
  EXPECT_DOUBLE_EQ(variance(halves(9, 9)), 0);
  EXPECT_NEAR(score(halves(7, 8), halves(10, 30)).explained, 1, 1e-12);  // rounding of the fit
  EXPECT_DOUBLE_EQ(score(halves(8, 7), halves(10, 30)).explained, 0);    // the negative
  EXPECT_DOUBLE_EQ(score(halves(1, 2), halves(9, 9)).explained, 0);      // nothing to explain
  // Of levels 0, 0, 20, 20 by columns a picture 0, 20, 20, 20 explains a third: r^2 of both.
  Picture reference = halves(0, 20), picture = reference;
  for (int y = 0; y < 12; ++y)
    for (int x = 3; x < 6; ++x) picture(x, y) = 20;
  EXPECT_NEAR(score(picture, reference).explained, 1.0 / 3, 1e-12);  // rounding
}

TEST(MethodScores, are_of_pictures_that_the_window_of_the_comparison_fits_into) {
  const auto square = [](int side_px) { return Picture({side_px, side_px}); };
  EXPECT_EQ(too_small({kLeastSide_px, kLeastSide_px}), "");
  EXPECT_NO_THROW(score(square(kLeastSide_px), square(kLeastSide_px)));
  EXPECT_EQ(too_small({40, 10}), "40x10 px, allowed from 11x11 px");
  EXPECT_EQ(too_small({10, 40}), "10x40 px, allowed from 11x11 px");
  EXPECT_THROW(score(square(kLeastSide_px - 1), square(kLeastSide_px - 1)), std::invalid_argument);
}

TEST(MethodScores, of_several_frames_are_means) {
  EXPECT_FALSE(mean_score({}));
  const auto mean = mean_score({{core::Time(1), number(1)}, {core::Time(2), number(4)}});
  ASSERT_TRUE(mean);
  EXPECT_DOUBLE_EQ(mean->quality.gain, 2.5);
  EXPECT_DOUBLE_EQ(mean->quality.offset_levels, -2.5);
  EXPECT_DOUBLE_EQ(mean->quality.mse, 25);
  EXPECT_DOUBLE_EQ(mean->quality.psnr_db, 50);
  EXPECT_DOUBLE_EQ(mean->quality.ssim, 0.25);
  EXPECT_DOUBLE_EQ(mean->explained, 0.5);
}

TEST(MethodScores, say_how_many_frames_were_compared_and_why_not_all) {
  EXPECT_EQ(to_text({.compared = 1}), "1 frame compared");
  EXPECT_EQ(to_text({.compared = 12, .too_early = 1, .exposed_too_long = 2}),
            "12 frames compared, 3 left out: 1 too early, 2 exposed for too long");
  EXPECT_EQ(to_text({.after_events = 4, .unfit = 5}),
            "0 frames compared, 9 left out: 4 after the last event, 5 of part of the sensor or of "
            "one grey level");
}

MethodScores sample() {
  MethodScores scores;
  scores.methods.push_back({.method = "edi",
                            .saw_frames = true,
                            .score = number(1),
                            .frames = {{core::Time(42), number(1)}},
                            .skipped = ""});
  scores.methods.push_back({.method = "esi",
                            .saw_frames = false,
                            .score = number(2),
                            .frames = {{core::Time(42), number(2)}},
                            .skipped = ""});
  scores.methods.emplace_back();
  scores.methods.back().method = "e2vid";
  scores.methods.back().skipped = "no weights";
  return scores;
}

TEST(MethodScores, come_as_a_table) {
  MethodScores scores = sample();
  EXPECT_EQ(to_table(scores),
            "method  MSE   PSNR dB  SSIM    explained  gain   made of\n"
            "edi     10.0  20.00    0.1000  0.2000     1.000  events, frames\n"
            "esi     20.0  40.00    0.2000  0.4000     2.000  events\n"
            "e2vid   -     -        -       -          -      skipped: no weights\n");
  scores.frames = FrameCount{.compared = 1, .too_early = 2};
  EXPECT_THAT(to_table(scores), HasSubstr("\n1 frame compared, 2 left out: 2 too early\n"));
}

TEST(MethodScores, come_as_json_with_a_score_for_each_frame) {
  MethodScores scores = sample();
  EXPECT_THAT(to_json(scores), Not(HasSubstr("left_out")));
  scores.frames = FrameCount{.compared = 1, .unfit = 3};
  const auto json = nlohmann::json::parse(to_json(scores));
  EXPECT_EQ(json["frames"]["compared"], 1);
  EXPECT_EQ(json["frames"]["left_out"]["unfit"], 3);
  EXPECT_EQ(json["frames"]["left_out"]["too_early"], 0);
  const auto& esi = json["methods"][1];
  EXPECT_EQ(esi["method"], "esi");
  EXPECT_EQ(esi["saw_frames"], false);
  EXPECT_EQ(json["methods"][0]["saw_frames"], true);
  EXPECT_EQ(esi["explained"], 0.4);
  EXPECT_EQ(esi["frames"].size(), 1u);
  EXPECT_EQ(esi["frames"][0]["time_us"], 42);
  EXPECT_EQ(esi["frames"][0]["mse"], 20);
  EXPECT_EQ(json["methods"][2]["skipped"], "no weights");
  EXPECT_FALSE(json["methods"][2].contains("mse"));
}

}  // namespace
}  // namespace nightjar::scenarios
