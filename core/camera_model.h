#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/event.h"
#include "core/lens.h"

namespace nightjar::core {

/// Pinhole behind a lens, ideal by default. Camera axes: x right, y down, z forward.
/// Pixel centres lie at whole numbers: (0, 0) is the middle of the top left
/// pixel, so the picture spans [-0.5, width - 0.5) x [-0.5, height - 0.5).
struct CameraModel {
  Resolution size;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  Lens lens = {};

  /// Square pixels, principal point in the middle, `fovy_rad` over the height.
  static CameraModel from_fovy(Resolution size, double fovy_rad);

  /// Pixel of a point in camera axes (m); nothing for a point not in front, or beyond what
  /// the lens shows (Lens::distort).
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera_m) const;

  /// Direction through a pixel, in camera axes, with z = 1; NaN for a pixel the lens lets
  /// nothing be seen at (Lens::undistort).
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel_px) const;

  /// The same camera with an ideal lens.
  CameraModel pinhole() const;

  /// The pixel at which pinhole() sees what this camera sees at `pixel_px`; NaN as for ray().
  Eigen::Vector2d undistorted(const Eigen::Vector2d& pixel_px) const;

  /// Whether a pixel position lies on the sensor, `margin_px` inside its rim.
  bool contains(const Eigen::Vector2d& pixel_px, double margin_px = 0) const;
};

}  // namespace nightjar::core
