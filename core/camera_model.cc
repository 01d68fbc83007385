#include "core/camera_model.h"

#include <cmath>
#include <limits>

namespace nightjar::core {

CameraModel CameraModel::from_fovy(Resolution size, double fovy_rad) {
  const double f_px = 0.5 * size.height_px / std::tan(0.5 * fovy_rad);
  return {size, f_px, f_px, 0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1), {}};
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p) const {
  constexpr double kNearest_m = 1e-6;
  if (p.z() < kNearest_m) return std::nullopt;
  if (lens.is_ideal())
    return Eigen::Vector2d(fx_px * p.x() / p.z() + cx_px, fy_px * p.y() / p.z() + cy_px);
  const auto seen = lens.distort({p.x() / p.z(), p.y() / p.z()});
  if (!seen) return std::nullopt;
  return Eigen::Vector2d(fx_px * seen->x() + cx_px, fy_px * seen->y() + cy_px);
}

Eigen::Vector3d CameraModel::ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d seen((pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px);
  if (lens.is_ideal()) return {seen.x(), seen.y(), 1.0};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d ideal = lens.undistort(seen).value_or(Eigen::Vector2d(kNone, kNone));
  return {ideal.x(), ideal.y(), 1.0};
}

CameraModel CameraModel::pinhole() const { return {size, fx_px, fy_px, cx_px, cy_px, {}}; }

Eigen::Vector2d CameraModel::undistorted(const Eigen::Vector2d& pixel) const {
  if (lens.is_ideal()) return pixel;  // to the bit
  const Eigen::Vector3d r = ray(pixel);
  return {fx_px * r.x() + cx_px, fy_px * r.y() + cy_px};
}

bool CameraModel::contains(const Eigen::Vector2d& pixel, double margin_px) const {
  return pixel.x() >= margin_px - 0.5 && pixel.y() >= margin_px - 0.5 &&
         pixel.x() < size.width_px - 0.5 - margin_px &&
         pixel.y() < size.height_px - 0.5 - margin_px;
}

}  // namespace nightjar::core
