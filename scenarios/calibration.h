#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "core/camera_model.h"
#include "scenarios/calibration_board.h"

namespace nightjar::scenarios {

/// Fewer views that differ do not tell a lens from a tilt.
inline constexpr std::size_t kLeastViews = 8;

/// The cells that coverage is counted in.
inline constexpr int kCellColumns = 8, kCellRows = 6;

/// One view and what is left of it: residual_px[i] = corner_px[i] - its projection.
struct CalibratedView : BoardView {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> residual_px;
  double rms_px = 0;  ///< Of the residuals' lengths.
};

struct Calibration {
  core::CameraModel camera;
  /// One standard deviation of each number in `camera`, for corners that scatter as the
  /// residuals do; 0 for what was held fixed. Its size means nothing.
  core::CameraModel sigma;
  std::vector<CalibratedView> views;
  std::vector<BoardView> left_out;  ///< Views that fit far worse than the rest.
  double rms_px = 0;                ///< Of all residuals' lengths.

  /// Which cells of a grid over the picture a corner lies in, row by row.
  std::array<bool, kCellColumns * kCellRows> cells() const;

  /// Share of them.
  double covered() const;
};

struct CalibrationOptions {
  bool k3 = false;  ///< Estimate it; else 0. Only wide lenses need it.
};

/// Intrinsics by OpenCV's calibrateCamera (Zhang 2000) from views of one board by one camera.
/// After a first fit the views with an rms over three times the median are left out, and it is
/// fitted again. Throws std::invalid_argument for fewer than kLeastViews views (before or after
/// that) and for views that do not make a camera.
Calibration calibrate(const std::vector<BoardView>& views, core::Resolution size,
                      const CalibrationOptions& options);

}  // namespace nightjar::scenarios
