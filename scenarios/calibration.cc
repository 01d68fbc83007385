#include "scenarios/calibration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <utility>

#include "scenarios/intrinsics.h"

namespace nightjar::scenarios {
namespace {

constexpr double kMostOfMedian = 3;  // a board taken for what it is not is off by pixels

/// In OpenCV's order of calibrateCamera's standard deviations.
core::CameraModel model_of(core::Resolution size, const cv::Mat& v) {
  const auto at = [&](int i) { return v.at<double>(i); };
  return {size, at(0), at(1), at(2), at(3), {at(4), at(5), at(6), at(7), at(8)}};
}

Eigen::Isometry3d pose_of(const cv::Mat& turn, const cv::Mat& shift) {
  const Eigen::Vector3d v(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (v.norm() > 0) T.linear() = Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
  T.translation() << shift.at<double>(0), shift.at<double>(1), shift.at<double>(2);
  return T;
}

/// Fills in the residuals; false where the camera does not see a corner that was seen.
bool measure(CalibratedView& view, const core::CameraModel& camera) {
  double sum_px2 = 0;
  for (std::size_t i = 0; i < view.corner_px.size(); ++i) {
    const Eigen::Vector3d corner_m(view.corner_m[i].x(), view.corner_m[i].y(), 0);
    const auto pixel = camera.project(view.T_camera_board * corner_m);
    if (!pixel) return false;
    view.residual_px.push_back(view.corner_px[i] - *pixel);
    sum_px2 += view.residual_px.back().squaredNorm();
  }
  view.rms_px = std::sqrt(sum_px2 / static_cast<double>(view.corner_px.size()));
  return true;
}

[[noreturn]] void refuse() {
  throw std::invalid_argument(
      "these views do not make a camera: is the board as described, flat, and seen tilted, near "
      "and far?");
}

/// What calibrateCamera() gives back.
struct Fit {
  cv::Mat intrinsics = cv::Mat::zeros(9, 1, CV_64F);  // fx fy cx cy k1 k2 p1 p2 k3
  cv::Mat sigma;                                      // of the same
  std::vector<cv::Mat> turns, shifts;
};

Fit fit(const std::vector<BoardView>& views, core::Resolution size, bool k3) {
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> seen;
  for (const BoardView& view : views) {
    auto& printed = board.emplace_back();
    auto& pixels = seen.emplace_back();
    for (const Eigen::Vector2d& p : view.corner_m)
      printed.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0f);
    for (const Eigen::Vector2d& p : view.corner_px)
      pixels.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  Fit result;
  cv::Mat K, distortion, unused;
  cv::calibrateCamera(board, seen, {size.width_px, size.height_px}, K, distortion, result.turns,
                      result.shifts, result.sigma, unused, unused, k3 ? 0 : cv::CALIB_FIX_K3,
                      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-10});
  const double pinhole[] = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2),
                            K.at<double>(1, 2)};
  for (int i = 0; i < 4; ++i) result.intrinsics.at<double>(i) = pinhole[i];
  for (int i = 0; i < 5; ++i) result.intrinsics.at<double>(4 + i) = distortion.at<double>(i);
  return result;
}

Calibration fitted(const std::vector<BoardView>& views, core::Resolution size, bool k3) {
  Calibration result;
  try {
    const Fit found = fit(views, size, k3);
    result.camera = model_of(size, found.intrinsics);
    result.sigma = model_of(size, found.sigma);
    for (std::size_t i = 0; i < views.size(); ++i)
      result.views.push_back({views[i], pose_of(found.turns[i], found.shifts[i]), {}, 0});
  } catch (const cv::Exception&) {
    refuse();
  }
  double sum_px2 = 0, corners = 0;
  for (CalibratedView& view : result.views) {
    if (!measure(view, result.camera)) refuse();
    corners += static_cast<double>(view.corner_px.size());
    sum_px2 += view.rms_px * view.rms_px * static_cast<double>(view.corner_px.size());
  }
  result.rms_px = std::sqrt(sum_px2 / corners);
  if (!std::isfinite(result.rms_px) || !sees_with_all_pixels(result.camera)) refuse();
  return result;
}

double median_rms_px(const std::vector<CalibratedView>& views) {
  std::vector<double> rms;
  for (const CalibratedView& view : views) rms.push_back(view.rms_px);
  std::ranges::nth_element(rms, rms.begin() + static_cast<std::ptrdiff_t>(rms.size() / 2));
  return rms[rms.size() / 2];
}

void check_count(std::size_t views) {
  if (views < kLeastViews)
    throw std::invalid_argument(
        fmt::format("{} views of the board that differ, expected at least {}", views, kLeastViews));
}

}  // namespace

std::array<bool, kCellColumns * kCellRows> Calibration::cells() const {
  std::array<bool, kCellColumns * kCellRows> cells{};
  const core::Resolution size = camera.size;
  for (const CalibratedView& view : views)
    for (const Eigen::Vector2d& p : view.corner_px) {
      const double x = (p.x() + 0.5) / size.width_px, y = (p.y() + 0.5) / size.height_px;
      const int column = std::clamp(static_cast<int>(x * kCellColumns), 0, kCellColumns - 1);
      const int row = std::clamp(static_cast<int>(y * kCellRows), 0, kCellRows - 1);
      cells[static_cast<std::size_t>(row * kCellColumns + column)] = true;
    }
  return cells;
}

double Calibration::covered() const {
  const auto all = cells();
  return static_cast<double>(std::ranges::count(all, true)) / static_cast<double>(all.size());
}

Calibration calibrate(const std::vector<BoardView>& views, core::Resolution size,
                      const CalibrationOptions& options) {
  check_count(views.size());
  Calibration first = fitted(views, size, options.k3);
  const double most_px = kMostOfMedian * median_rms_px(first.views);
  std::vector<BoardView> good, bad;
  for (const CalibratedView& view : first.views)
    (view.rms_px <= most_px ? good : bad).push_back(view);
  if (bad.empty()) return first;
  check_count(good.size());
  Calibration second = fitted(good, size, options.k3);
  second.left_out = std::move(bad);
  return second;
}

}  // namespace nightjar::scenarios
