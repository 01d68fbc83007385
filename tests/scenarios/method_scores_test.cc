#include "scenarios/method_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

/// A square in the middle turns bright, so a good picture is that square.
class MethodScoresTest : public testing::Test {
 protected:
  MethodScoresTest() {
    std::ofstream text(folder_ / "events.txt");
    for (int i = 0; i < 3; ++i)
      for (int y = 8; y < 16; ++y)
        for (int x = 8; x < 16; ++x) {
          text << "0.0" << i + 1 << ' ' << x << ' ' << y << " 1\n";
          square_(x, y) = 200;
        }
  }

  test::ScratchFolder folder_;
  core::Image<std::uint8_t> square_{{24, 24}, 50};
};

TEST_F(MethodScoresTest, scores_a_right_picture_high_and_a_wrong_one_low) {
  MethodScoresOptions options;
  options.methods = {esi::Method::esi};
  const auto right = score_methods(folder_ / "events.txt", square_, options);
  ASSERT_EQ(right.size(), 1u);
  EXPECT_EQ(right[0].method, "esi");
  EXPECT_NEAR(right[0].quality->ssim, 1, 1e-9);  // two levels: the fit is exact
  core::Image<std::uint8_t> stripes({24, 24});
  for (int x = 0; x < 24; x += 3)
    for (int y = 0; y < 24; ++y) stripes(x, y) = 255;
  EXPECT_LT(score_methods(folder_ / "events.txt", stripes, options)[0].quality->ssim, 0.3);
}

TEST_F(MethodScoresTest, says_which_methods_were_skipped_and_why) {
  MethodScoresOptions options;
  options.methods = {esi::Method::firenet, esi::Method::edi, esi::Method::esi};
  const auto scores = score_methods(folder_ / "events.txt", square_, options);
  EXPECT_EQ(scores[0].skipped, "no weights: reconstructor.firenet.weights");
  EXPECT_EQ(scores[1].skipped, "needs frames, the recording holds none");
  EXPECT_FALSE(scores[0].quality || scores[1].quality);
  EXPECT_THAT(to_table(scores), HasSubstr("skipped: no weights"));
  const auto json = nlohmann::json::parse(to_json(scores));
  EXPECT_EQ(json[1]["skipped"], "needs frames, the recording holds none");
  EXPECT_GT(json[2]["ssim"], 0.99);
  EXPECT_FALSE(json[2].contains("skipped"));
}

TEST_F(MethodScoresTest, refuses_a_reference_of_another_size) {
  MethodScoresOptions options;
  options.methods = {esi::Method::esi};
  EXPECT_THROW(score_methods(folder_ / "events.txt", core::Image<std::uint8_t>({12, 12}), options),
               std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::scenarios
