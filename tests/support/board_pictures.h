#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <vector>

#include "core/camera_model.h"
#include "core/image.h"
#include "scenarios/calibration_board.h"
#include "tracker/tag_image.h"

namespace nightjar::test {

/// The reflectance of a board's plane at (x, y) in board axes (m).
using BoardPaint = std::function<double(double x_m, double y_m)>;

/// Black 0.05 and white 0.9 squares; the first inner corner is the origin, a white margin of
/// one square is around, grey 0.3 beyond.
inline BoardPaint checkerboard_paint(const scenarios::Checkerboard& board) {
  return [board](double x_m, double y_m) {
    const int column = static_cast<int>(std::floor(x_m / board.square_m)) + 1;
    const int row = static_cast<int>(std::floor(y_m / board.square_m)) + 1;
    if (column < -1 || row < -1 || column > board.columns + 1 || row > board.rows + 1) return 0.3;
    const bool squares = column >= 0 && row >= 0 && column <= board.columns && row <= board.rows;
    return squares && (column + row) % 2 == 0 ? 0.05 : 0.9;
  };
}

/// The tags with their white borders (a quarter wider than the black square) on grey 0.3.
inline BoardPaint tag_board_paint(const scenarios::TagBoardConfig& board) {
  std::vector<core::Image<std::uint8_t>> images;
  for (const auto& tag : board.tags) images.push_back(tracker::tag_image(tag.id, 1));
  return [board, images](double x_m, double y_m) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      const scenarios::BoardTag& tag = board.tags[i];
      const double cell_m = tag.size_m / 8;  // x is up, y to the left
      const int column = static_cast<int>(std::floor((tag.y_m - y_m) / cell_m)) + 5;
      const int row = static_cast<int>(std::floor((tag.x_m - x_m) / cell_m)) + 5;
      if (column >= 0 && row >= 0 && column < 10 && row < 10)
        return images[i](column, row) > 127 ? 0.9 : 0.05;
    }
    return 0.3;
  };
}

/// What turns a board's axes into the camera's when it is seen squarely.
inline const Eigen::Matrix3d kCheckerboardFace = Eigen::Matrix3d::Identity();
inline const Eigen::Matrix3d kTagFace =
    (Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished();

/// Twelve tags of 5 cm, 6.5 cm apart, ids row by row from the top left, whose middle is origin.
inline scenarios::TagBoardConfig tag_board() {
  scenarios::TagBoardConfig board{{}};
  for (int i = 0; i < 12; ++i) board.tags.push_back({i, 0.05, -0.065 * (i / 4), -0.065 * (i % 4)});
  return board;
}
inline const Eigen::Vector2d kTagBoardMiddle_m(-0.065, -0.0975);

/// Draws a board as a camera with any lens sees it: every pixel the mean of fine x fine rays.
class BoardCamera {
 public:
  explicit BoardCamera(const core::CameraModel& camera, int fine = 4)
      : camera_(camera), fine_(fine) {
    for (int y = 0; y < fine * camera.size.height_px; ++y)
      for (int x = 0; x < fine * camera.size.width_px; ++x)
        rays_.push_back(camera.ray({(x + 0.5) / fine - 0.5, (y + 0.5) / fine - 0.5}));
  }

  const core::CameraModel& model() const { return camera_; }

  core::Picture draw(const BoardPaint& paint, const Eigen::Isometry3d& T_camera_board) const {
    const Eigen::Isometry3d T_board_camera = T_camera_board.inverse();
    const Eigen::Vector3d eye = T_board_camera.translation();
    core::Image<float> sum(camera_.size);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const Eigen::Vector3d ray = T_board_camera.linear() * rays_[i];
      const Eigen::Vector3d p = eye - eye.z() / ray.z() * ray;
      const int fine_width = fine_ * camera_.size.width_px, n = static_cast<int>(i);
      sum(n % fine_width / fine_, n / fine_width / fine_) +=
          static_cast<float>(paint(p.x(), p.y()) / (fine_ * fine_));
    }
    core::Picture picture{{}, core::Image<std::uint8_t>(camera_.size)};
    for (std::size_t i = 0; i < sum.pixels().size(); ++i)
      picture.gray.pixels()[i] = static_cast<std::uint8_t>(std::lround(255 * sum.pixels()[i]));
    return picture;
  }

 private:
  core::CameraModel camera_;
  int fine_;
  std::vector<Eigen::Vector3d> rays_;
};

/// About a DAVIS346 with a 6 mm lens of barrel shape, decentred: 7 px at the corners.
inline core::CameraModel distorting_camera() {
  return {{346, 260}, 301.2, 299.4, 169.3, 133.1, {-0.21, 0.07, 0.0012, -0.0008, 0}};
}

/// View i of a series that show a board of `width_m` with its middle at `middle_m` all over the
/// picture, whole, near and far, turned by 20 to 40 degrees about changing axes.
inline Eigen::Isometry3d board_pose(int i, const Eigen::Vector2d& middle_m, double width_m,
                                    const Eigen::Matrix3d& face) {
  const double around = 2.4 * i;  // the golden angle: places spread over a disc
  const double out = std::sqrt((i % 7 + 0.5) / 7);
  const double away_m = width_m * (1.4 + 0.6 * std::fmod(0.618 * i, 1.0));
  const double aside_m = 0.55 * away_m - 0.52 * width_m, up_m = 0.42 * away_m - 0.39 * width_m;
  const Eigen::Vector3d axis(std::cos(1.7 * i), std::sin(1.7 * i), 0.3 * std::sin(2.9 * i));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::AngleAxisd(0.35 + 0.35 * std::fmod(0.4142 * i, 1.0), axis.normalized()) * face;
  T.translation() =
      Eigen::Vector3d(aside_m * out * std::cos(around), up_m * out * std::sin(around), away_m) -
      T.linear() * Eigen::Vector3d(middle_m.x(), middle_m.y(), 0);
  return T;
}

}  // namespace nightjar::test
