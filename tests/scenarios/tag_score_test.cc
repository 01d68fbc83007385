#include "scenarios/tag_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/picture_records.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

const core::CameraModel kCamera = test::davis_camera();

TagScore score(const core::Truth& truth, const std::vector<core::TagDetection>& tags) {
  return score_tags(kCamera, truth, {.id = 0, .size_m = test::kTagSize_m}, tags);
}

/// A right detection with every corner moved by this much.
core::TagDetection moved(double x_px, double y_px) {
  core::TagDetection tag = test::tag_at(0us, test::corners_straight_below());
  for (Eigen::Vector2d& corner : tag.corner_px) corner += Eigen::Vector2d(x_px, y_px);
  return tag;
}

TEST(ProjectTag, PutsTheCornersOfATagStraightBelowInAprilTagsOrder) {
  const auto corners_px = project_tag(kCamera, test::straight_below(0us), test::kTagSize_m);
  ASSERT_TRUE(corners_px);
  for (std::size_t i = 0; i < 4; ++i)  // a few roundings of numbers near 200
    EXPECT_LT(((*corners_px)[i] - test::corners_straight_below()[i]).norm(), 1e-9) << i;
}

TEST(ProjectTag, TurnsTheCornersWithTheTag) {
  core::Truth truth = test::straight_below(0us);
  // A quarter turn to the left, so the top edge is on the picture's left.
  truth.T_world_tag.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  const auto corners_px = project_tag(kCamera, truth, test::kTagSize_m);
  ASSERT_TRUE(corners_px);
  const auto upright = test::corners_straight_below();
  for (std::size_t i = 0; i < 4; ++i)  // bottom left now lies where bottom right was
    EXPECT_LT(((*corners_px)[i] - upright[(i + 1) % 4]).norm(), 1e-9) << i;
}

TEST(ProjectTag, SeesNothingBehindTheCamera) {
  core::Truth truth = test::straight_below(0us);
  truth.T_world_tag.translation().z() = 2.0;  // above the camera, which looks down
  EXPECT_FALSE(project_tag(kCamera, truth, test::kTagSize_m));
  EXPECT_EQ(score(truth, {moved(0, 0)}).false_detections, 1);
}

TEST(ScoreTags, CountsATagWhereItIs) {
  const TagScore s = score(test::straight_below(0us), {moved(0, 0)});
  EXPECT_TRUE(s.detected);
  EXPECT_EQ(s.false_detections, 0);
}

TEST(ScoreTags, CountsNothingWhereNothingWasDecoded) {
  const TagScore s = score(test::straight_below(0us), {});
  EXPECT_FALSE(s.detected);
  EXPECT_EQ(s.false_detections, 0);
}

TEST(ScoreTags, AllowsFivePixelsAndNoMore) {
  EXPECT_TRUE(score(test::straight_below(0us), {moved(4.999, 0)}).detected);
  EXPECT_FALSE(score(test::straight_below(0us), {moved(0, -5.001)}).detected);
  EXPECT_FALSE(score(test::straight_below(0us), {moved(4, 4)}).detected);  // 5.66 px away
}

TEST(ScoreTags, WantsEveryCornerRight) {
  for (std::size_t i = 0; i < 4; ++i) {
    core::TagDetection tag = moved(0, 0);
    tag.corner_px[i].x() += 6;
    const TagScore s = score(test::straight_below(0us), {tag});
    EXPECT_FALSE(s.detected) << i;
    EXPECT_EQ(s.false_detections, 1) << i;
  }
}

TEST(ScoreTags, WantsTheCornersInTheirOrder) {
  core::TagDetection tag = moved(0, 0);
  std::ranges::rotate(tag.corner_px, tag.corner_px.begin() + 1);
  EXPECT_FALSE(score(test::straight_below(0us), {tag}).detected);
}

TEST(ScoreTags, TakesCornersThatAreNoNumbersForFalse) {
  const TagScore s =
      score(test::straight_below(0us), {moved(std::numeric_limits<double>::quiet_NaN(), 0)});
  EXPECT_FALSE(s.detected);
  EXPECT_EQ(s.false_detections, 1);
}

TEST(ScoreTags, TakesAnotherIdForFalse) {
  core::TagDetection tag = moved(0, 0);
  tag.id = 1;
  const TagScore s = score(test::straight_below(0us), {tag});
  EXPECT_FALSE(s.detected);
  EXPECT_EQ(s.false_detections, 1);
}

TEST(ScoreTags, ComparesWithTheTagThatIsPrinted) {
  core::TagDetection tag = moved(0, 0);
  tag.id = 1;
  const core::Truth truth = test::straight_below(0us);
  EXPECT_TRUE(score_tags(kCamera, truth, {.id = 1, .size_m = test::kTagSize_m}, {{tag}}).detected);
  // Half the size puts each corner 15 px in x and y from where it was seen.
  const TagConfig small{.id = 1, .size_m = test::kTagSize_m / 2};
  EXPECT_FALSE(score_tags(kCamera, truth, small, {{tag}}).detected);
}

TEST(ScoreTags, CountsAtMostOneDetectionAPicture) {
  const TagScore s = score(test::straight_below(0us), {moved(100, 0), moved(1, 0), moved(0, 0)});
  EXPECT_TRUE(s.detected);
  EXPECT_EQ(s.false_detections, 2);
}

}  // namespace
}  // namespace nightjar::scenarios
