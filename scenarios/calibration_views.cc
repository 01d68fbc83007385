#include "scenarios/calibration_views.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace nightjar::scenarios {
namespace {

/// Nearer views add noise rather than knowledge: a twentieth of the picture's width, or 8 % of
/// the board's size, or its far edge 2.5 % smaller.
constexpr double kSameView = 0.05;

/// Place (of the picture's width), log of the size, and tilt about two axes (how much smaller
/// the board's far end looks), each weighed so that 1 is a big difference.
using Features = Eigen::Matrix<double, 5, 1>;

/// h31 and h32 of the homography from the board, in units of its extent, to the picture.
Eigen::Vector2d perspective(const BoardView& view, const Eigen::Vector2d& middle_m,
                            double extent_m) {
  std::vector<cv::Point2d> board, seen;
  for (std::size_t i = 0; i < view.corner_m.size(); ++i) {
    const Eigen::Vector2d p = (view.corner_m[i] - middle_m) / extent_m;
    board.emplace_back(p.x(), p.y());
    seen.emplace_back(view.corner_px[i].x(), view.corner_px[i].y());
  }
  const cv::Mat H = cv::findHomography(board, seen);
  if (H.empty()) return Eigen::Vector2d::Zero();
  return Eigen::Vector2d(H.at<double>(2, 0), H.at<double>(2, 1)) / H.at<double>(2, 2);
}

Features features(const BoardView& view, core::Resolution size) {
  Eigen::AlignedBox2d board, seen;
  for (const Eigen::Vector2d& corner : view.corner_m) board.extend(corner);
  for (const Eigen::Vector2d& corner : view.corner_px) seen.extend(corner);
  const double extent_m = board.sizes().maxCoeff();
  const Eigen::Vector2d middle = seen.center() / size.width_px;
  const double scale = std::sqrt(seen.volume() / board.volume()) * extent_m;
  const Eigen::Vector2d tilt = perspective(view, board.center(), extent_m);
  Features result;
  result << middle, 0.6 * std::log(std::max(scale, 1e-6)), 2 * tilt;
  return result;
}

}  // namespace

std::vector<BoardView> choose_views(const std::vector<BoardView>& views, core::Resolution size,
                                    std::size_t most) {
  std::vector<Features> all;
  for (const BoardView& view : views) all.push_back(features(view, size));
  std::vector<double> apart(views.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen;
  while (chosen.size() < std::min(most, views.size())) {
    const auto next = static_cast<std::size_t>(std::ranges::max_element(apart) - apart.begin());
    if (apart[next] < kSameView) break;
    chosen.push_back(next);
    for (std::size_t i = 0; i < all.size(); ++i)
      apart[i] = std::min(apart[i], (all[i] - all[next]).norm());
  }
  std::ranges::sort(chosen);
  std::vector<BoardView> result;
  for (const std::size_t i : chosen) result.push_back(views[i]);
  return result;
}

}  // namespace nightjar::scenarios
