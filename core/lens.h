#pragma once

#include <Eigen/Core>
#include <optional>

namespace nightjar::core {

/// Radial-tangential distortion with OpenCV's coefficients: what lies at (x, y) on the plane
/// z = 1 in camera axes (no unit) is seen where the undistorted (x', y') would be,
///     x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),
///     y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y.
/// All 0: an ideal lens.
struct Lens {
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double k3 = 0;

  bool is_ideal() const;

  /// (x', y') of (x, y); nothing beyond the radius where the radial polynomial turns back:
  /// out there it puts things into the picture that are not in it.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector2d& ideal) const;

  /// (x, y) of (x', y'), to 1e-12; nothing where no (x, y) is seen.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& seen) const;

  friend constexpr bool operator==(const Lens&, const Lens&) = default;
};

}  // namespace nightjar::core
