#include "scenarios/calibration_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/board_pictures.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

const Checkerboard kCheckerboard{9, 6, 0.03};

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

/// Where the camera sees a board's corner.
Eigen::Vector2d pixel_of(const core::CameraModel& camera, const Eigen::Isometry3d& T_camera_board,
                         const Eigen::Vector2d& corner_m) {
  return *camera.project(T_camera_board * Eigen::Vector3d(corner_m.x(), corner_m.y(), 0));
}

/// Of the distances of seen corners from where they are; a checkerboard may be seen from either
/// end, which turns it by 180 degrees about its middle.
double rms_px(const BoardView& view, const core::CameraModel& camera, const Eigen::Isometry3d& T,
              bool turned = false) {
  double sum = 0;
  for (std::size_t i = 0; i < view.corner_m.size(); ++i) {
    const Eigen::Vector2d corner_m =
        turned ? Eigen::Vector2d(0.24, 0.15) - view.corner_m[i] : view.corner_m[i];
    sum += (view.corner_px[i] - pixel_of(camera, T, corner_m)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(view.corner_m.size()));
}

TEST(CheckerboardFinderTest, finds_all_inner_corners_where_they_are) {
  const test::BoardCamera camera(test::distorting_camera());
  const auto finder = make_checkerboard_finder(kCheckerboard);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Isometry3d T = test::board_pose(i, {0.12, 0.075}, 0.3, test::kCheckerboardFace);
    const auto view = finder->find(camera.draw(test::checkerboard_paint(kCheckerboard), T));
    ASSERT_TRUE(view) << i;
    ASSERT_EQ(view->corner_px.size(), 54u);
    // Squares of 10 to 15 px, corners good to about a tenth: 24 views gave 0.06 to 0.12 px.
    EXPECT_LT(std::min(rms_px(*view, camera.model(), T), rms_px(*view, camera.model(), T, true)),
              0.2);
  }
}

TEST(CheckerboardFinderTest, keeps_clear_of_the_neighbouring_rows_of_a_board_tilted_far) {
  // Rows come to lie 5 px apart where columns are 14 px apart: a window that only knew of the
  // columns would reach into the next row.
  const test::BoardCamera camera(test::distorting_camera());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(1.15, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0, 0, 0.6) - T.linear() * Eigen::Vector3d(0.12, 0.075, 0);
  const auto view = make_checkerboard_finder(kCheckerboard)
                        ->find(camera.draw(test::checkerboard_paint(kCheckerboard), T));
  ASSERT_TRUE(view);
  EXPECT_LT(std::min(rms_px(*view, camera.model(), T), rms_px(*view, camera.model(), T, true)),
            0.2);
}

TEST(CheckerboardFinderTest, finds_nothing_where_part_of_the_board_is_missing) {
  const test::BoardCamera camera(test::distorting_camera());
  Eigen::Isometry3d T = test::board_pose(0, {0.12, 0.075}, 0.3, test::kCheckerboardFace);
  T.translation().x() += 0.2;
  const auto finder = make_checkerboard_finder(kCheckerboard);
  EXPECT_FALSE(finder->find(camera.draw(test::checkerboard_paint(kCheckerboard), T)));
  EXPECT_FALSE(finder->find({{}, core::Image<std::uint8_t>({346, 260}, 90)}));
}

TEST(CheckerboardFinderTest, refuses_a_board_that_is_none) {
  EXPECT_THAT(error_of([] {
                make_checkerboard_finder({2, 6, 0.03});
              }),
              HasSubstr("corners.columns = 2, allowed 3 to 50"));
  EXPECT_THAT(error_of([] {
                make_checkerboard_finder({9, 51, 0.03});
              }),
              HasSubstr("corners.rows = 51"));
  EXPECT_THAT(error_of([] { make_checkerboard_finder({9, 6, 0}); }), HasSubstr("square_m = 0"));
}

TEST(TagBoardFinderTest, finds_four_corners_of_each_tag_where_they_are) {
  const test::BoardCamera camera(test::distorting_camera());
  const TagBoardConfig board = test::tag_board();
  const auto finder = make_tag_board_finder(board, {});
  for (int i = 0; i < 4; ++i) {
    const Eigen::Isometry3d T = test::board_pose(i, test::kTagBoardMiddle_m, 0.3, test::kTagFace);
    const auto view = finder->find(camera.draw(test::tag_board_paint(board), T));
    ASSERT_TRUE(view) << i;
    EXPECT_GE(view->corner_px.size(), 4u * 8);
    // Tags of 30 px with the detector's smoothing; see tag_detector_test.
    EXPECT_LT(rms_px(*view, camera.model(), T), 0.35) << i;
  }
}

TEST(TagBoardFinderTest, leaves_out_tags_that_are_not_the_boards_and_wants_two_that_are) {
  const test::BoardCamera camera(test::distorting_camera());
  const TagBoardConfig printed = test::tag_board();
  const Eigen::Isometry3d T = test::board_pose(0, test::kTagBoardMiddle_m, 0.3, test::kTagFace);
  const core::Picture picture = camera.draw(test::tag_board_paint(printed), T);
  TagBoardConfig three{{printed.tags[4], printed.tags[5], printed.tags[6]}};
  const auto view = make_tag_board_finder(three, {})->find(picture);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->corner_px.size(), 12u);
  three.tags[0].id = 100, three.tags[1].id = 101;  // one of three is left
  EXPECT_FALSE(make_tag_board_finder(three, {})->find(picture));
  EXPECT_TRUE(make_tag_board_finder({{printed.tags[5]}}, {})->find(picture));  // all of one
}

TEST(TagBoardFinderTest, refuses_a_layout_that_is_none) {
  EXPECT_THAT(error_of([] {
                make_tag_board_finder({{BoardTag{}, BoardTag{}}}, {});
              }),
              HasSubstr("id = 0 is there twice"));
  EXPECT_THAT(error_of([] { make_tag_board_finder({{BoardTag{.size_m = 0}}}, {}); }),
              HasSubstr("board.tags[0].size_m = 0"));
  EXPECT_THAT(error_of([] { make_tag_board_finder({{}}, {}); }), HasSubstr("board.tags.size = 0"));
}

TEST(TagBoardFinderTest, reads_a_layout_from_a_file) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "tags.yaml")
      << "tags:\n  - {id: 3, size_m: 0.08, x_m: 0.1, y_m: -0.2}\n  - {id: 4}\n";
  const TagBoardConfig board = read_tag_board(folder / "tags.yaml");
  ASSERT_EQ(board.tags.size(), 2u);
  EXPECT_EQ(board.tags[0].id, 3);
  EXPECT_EQ(board.tags[0].y_m, -0.2);
  EXPECT_EQ(board.tags[1].size_m, 0.24);
  std::ofstream(folder / "bad.yaml") << "tags:\n  - {id: 700}\n";
  EXPECT_THAT(error_of([&] { read_tag_board(folder / "bad.yaml"); }),
              HasSubstr("bad.yaml:2:6: tags[0].id = 700, allowed 0 to 586"));
}

}  // namespace
}  // namespace nightjar::scenarios
