#include "tracker/tag_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tracker/tag_detector.h"

namespace nightjar::tracker {
namespace {

constexpr int kCells = 10;

TEST(TagImage, HasTenCellsASideWithAWhiteBorderAroundABlackRing) {
  const auto image = tag_image(0, 5);
  ASSERT_EQ(image.size(), (core::Resolution{50, 50}));
  EXPECT_EQ(image(2, 2), 255);
  EXPECT_EQ(image(7, 7), 0);
  EXPECT_EQ(image(42, 42), 0);
  EXPECT_EQ(image(47, 47), 255);
}

TEST(TagImage, IsReadBackAsItsId) {
  for (const int id : {0, 1, 586}) {
    const auto tag = tag_image(id, 8);
    core::Picture picture{{}, core::Image<std::uint8_t>({120, 120}, 255)};
    for (int y = 0; y < tag.height(); ++y)
      for (int x = 0; x < tag.width(); ++x) picture.gray(20 + x, 20 + y) = tag(x, y);
    const auto found = TagDetector(DetectorConfig{}).detect(picture);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].id, id);
  }
}

TEST(TagImage, UnknownIdsAndEmptyCellsAreRefused) {
  EXPECT_THROW(tag_image(-1, 5), std::invalid_argument);
  EXPECT_THROW(tag_image(587, 5), std::invalid_argument);
  EXPECT_THROW(tag_image(0, 0), std::invalid_argument);
}

TEST(TagImage, TheLandingBoardsTextureShowsWhatLibapriltagDraws) {
  const cv::Mat board = cv::imread(std::string(NIGHTJAR_SOURCE_DIR) + "/models/textures/board.png",
                                   cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(board.empty());
  const int cell_px = board.cols / (2 * kCells);  // the tag is half as wide as the board
  const auto tag = tag_image(0, cell_px);
  const int left = (board.cols - tag.width()) / 2, top = (board.rows - tag.height()) / 2;
  for (int y = 0; y < tag.height(); ++y)
    for (int x = 0; x < tag.width(); ++x)
      ASSERT_EQ(board.at<std::uint8_t>(top + y, left + x) > 127, tag(x, y) > 127) << x << ' ' << y;
}

}  // namespace
}  // namespace nightjar::tracker
