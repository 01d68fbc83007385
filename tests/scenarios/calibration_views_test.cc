#include "scenarios/calibration_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/board_pictures.h"

namespace nightjar::scenarios {
namespace {

using testing::ElementsAre;

constexpr core::Resolution kSize{346, 260};

BoardView view_at(const std::string& name, const Eigen::Isometry3d& T) {
  const core::CameraModel camera = test::distorting_camera();
  BoardView view{name, {}, {}};
  for (int i = 0; i < 54; ++i) {
    view.corner_m.emplace_back(0.03 * (i % 9), 0.03 * (i / 9));
    view.corner_px.push_back(
        *camera.project(T * Eigen::Vector3d(view.corner_m[i].x(), view.corner_m[i].y(), 0)));
  }
  return view;
}

Eigen::Isometry3d pose(double x_m, double z_m, double turn_y_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(turn_y_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x_m, 0, z_m) - T.linear() * Eigen::Vector3d(0.12, 0.075, 0);
  return T;
}

std::vector<std::string> names(const std::vector<BoardView>& views) {
  std::vector<std::string> result;
  for (const BoardView& view : views) result.push_back(view.picture);
  return result;
}

TEST(CalibrationViewsTest, of_a_board_held_still_one_view_is_enough) {
  std::vector<BoardView> views;
  for (int i = 0; i < 20; ++i) views.push_back(view_at("still", pose(1e-4 * i, 0.5, 0)));
  EXPECT_THAT(names(choose_views(views, kSize, 40)), ElementsAre("still"));
}

TEST(CalibrationViewsTest, place_distance_and_tilt_each_make_a_view_another_one) {
  const std::vector<BoardView> views = {
      view_at("first", pose(0, 0.5, 0)), view_at("again", pose(1e-4, 0.5, 0)),
      view_at("aside", pose(0.05, 0.5, 0)), view_at("afar", pose(0, 0.7, 0)),
      view_at("tilted", pose(0, 0.5, 0.4))};
  EXPECT_THAT(names(choose_views(views, kSize, 40)),
              ElementsAre("first", "aside", "afar", "tilted"));
}

TEST(CalibrationViewsTest, of_many_the_most_different_are_taken) {
  std::vector<BoardView> views;
  for (int i = 0; i <= 20; ++i)
    views.push_back(view_at(std::to_string(i), pose(-0.1 + 0.01 * i, 0.6, 0)));
  EXPECT_THAT(names(choose_views(views, kSize, 3)), ElementsAre("0", "10", "20"));
}

TEST(CalibrationViewsTest, of_none_none_are_chosen) {
  EXPECT_TRUE(choose_views({}, kSize, 40).empty());
}

}  // namespace
}  // namespace nightjar::scenarios
