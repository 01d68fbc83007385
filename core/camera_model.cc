#include "core/camera_model.h"

#include <cmath>

namespace nightjar::core {

CameraModel CameraModel::from_fovy(Resolution size, double fovy_rad) {
  const double f_px = 0.5 * size.height_px / std::tan(0.5 * fovy_rad);
  return {size, f_px, f_px, 0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1)};
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p) const {
  constexpr double kNearest_m = 1e-6;
  if (p.z() < kNearest_m) return std::nullopt;
  return Eigen::Vector2d(fx_px * p.x() / p.z() + cx_px, fy_px * p.y() / p.z() + cy_px);
}

Eigen::Vector3d CameraModel::ray(const Eigen::Vector2d& pixel) const {
  return {(pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px, 1.0};
}

bool CameraModel::contains(const Eigen::Vector2d& pixel, double margin_px) const {
  return pixel.x() >= margin_px - 0.5 && pixel.y() >= margin_px - 0.5 &&
         pixel.x() < size.width_px - 0.5 - margin_px &&
         pixel.y() < size.height_px - 0.5 - margin_px;
}

}  // namespace nightjar::core
