#include "tracker/tag_pose.h"

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <utility>

// AprilTag has both solutions in estimate_tag_pose_orthogonal_iteration, but
// Debian's libapriltag 3.3.0 does not export it, only estimate_tag_pose, which
// keeps the better one. So: least squares on the reprojection error, started
// from the homography and from its mirror image.

namespace nightjar::tracker {
namespace {

using Corners = std::array<Eigen::Vector3d, 4>;
using Pixels = std::array<Eigen::Vector2d, 4>;  // of a pinhole
using Residual = Eigen::Matrix<double, 8, 1>;
using Jacobian = Eigen::Matrix<double, 8, 6>;

constexpr int kIterations = 50;         // 5 to 10 are the rule; a flat minimum takes more
constexpr double kConverged = 1e-10;    // rad and, relative to the range, m
constexpr double kSamePose_rad = 0.01;  // nearer solutions are one

/// Convex and seen from its face: with y down, all turns go to the left. NaN is neither.
bool is_front_of_square(const Pixels& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = p[(i + 1) % 4] - p[i];
    const Eigen::Vector2d b = p[(i + 2) % 4] - p[(i + 1) % 4];
    if (!(a.x() * b.y() - a.y() * b.x() < 0)) return false;
  }
  return true;
}

/// Pose from the homography between the tag's plane and z = 1.
std::optional<Eigen::Isometry3d> pose_of_homography(const Pixels& pixels, const Corners& corners,
                                                    const core::CameraModel& camera) {
  Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d r = camera.ray(pixels[i]);
    const double x = corners[i].x(), y = corners[i].y();
    A.row(2 * i) << x, y, 1, 0, 0, 0, -r.x() * x, -r.x() * y;
    A.row(2 * i + 1) << 0, 0, 0, x, y, 1, -r.y() * x, -r.y() * y;
    b.segment<2>(2 * i) = r.head<2>();
  }
  const Eigen::Matrix<double, 8, 1> h = A.fullPivLu().solve(b);
  const Eigen::Vector3d hx(h[0], h[3], h[6]), hy(h[1], h[4], h[7]), ht(h[2], h[5], 1);
  const double scale = 2 / (hx.norm() + hy.norm());
  if (!std::isfinite(scale)) return std::nullopt;

  Eigen::Matrix3d M;
  M << hx, hy, hx.cross(hy) * scale;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = svd.matrixU() * svd.matrixV().transpose();  // M's determinant is positive
  T.translation() = ht * scale;
  return T;
}

/// The other way a plane can be tilted and look alike: its normal mirrored at
/// the line of sight.
Eigen::Isometry3d mirrored(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d sight = T.translation().normalized();
  const Eigen::Vector3d normal = T.linear().col(2);
  const Eigen::Vector3d other = 2 * normal.dot(sight) * sight - normal;
  Eigen::Isometry3d result = T;
  result.linear() = Eigen::Quaterniond::FromTwoVectors(normal, other) * T.linear();
  return result;
}

/// Projection minus measurement, and its derivative by a turn in tag axes and
/// a shift in camera axes. False if a corner falls behind the camera.
bool linearise(const Eigen::Isometry3d& T, const Pixels& pixels, const Corners& corners,
               const core::CameraModel& camera, Residual& r, Jacobian& J) {
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d p = T * corners[i];
    const std::optional<Eigen::Vector2d> projected = camera.project(p);
    if (!projected) return false;
    r.segment<2>(2 * i) = *projected - pixels[i];
    Eigen::Matrix<double, 2, 3> by_point;
    by_point << camera.fx_px / p.z(), 0, -camera.fx_px * p.x() / (p.z() * p.z()),  //
        0, camera.fy_px / p.z(), -camera.fy_px * p.y() / (p.z() * p.z());
    Eigen::Matrix3d by_turn;
    for (int axis = 0; axis < 3; ++axis)
      by_turn.col(axis) = T.linear() * Eigen::Vector3d::Unit(axis).cross(corners[i]);
    J.block<2, 3>(2 * i, 0) = by_point * by_turn;
    J.block<2, 3>(2 * i, 3) = by_point;
  }
  return true;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Eigen::Matrix<double, 6, 1>& step) {
  Eigen::Isometry3d result = T;
  const double angle = step.head<3>().norm();
  if (angle > 0) result.linear() = T.linear() * Eigen::AngleAxisd(angle, step.head<3>() / angle);
  result.translation() += step.tail<3>();
  return result;
}

/// Levenberg-Marquardt from `T` to the nearest minimum.
std::optional<TagPoseSolution> refined(Eigen::Isometry3d T, const Pixels& pixels,
                                       const Corners& corners, const core::CameraModel& camera) {
  Residual r, r_new;
  Jacobian J, J_new;
  if (!linearise(T, pixels, corners, camera, r, J)) return std::nullopt;
  double damping = 1e-4;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix<double, 6, 6> normal = J.transpose() * J;
    normal.diagonal() *= 1 + damping;
    const Eigen::Matrix<double, 6, 1> step = -normal.ldlt().solve(J.transpose() * r);
    const Eigen::Isometry3d T_new = moved(T, step);
    if (!linearise(T_new, pixels, corners, camera, r_new, J_new) ||
        r_new.squaredNorm() > r.squaredNorm()) {
      damping *= 10;
      continue;
    }
    T = T_new, r = r_new, J = J_new;
    damping *= 0.1;
    if (step.head<3>().norm() < kConverged &&
        step.tail<3>().norm() < kConverged * T.translation().norm())
      break;
  }
  if (T.linear().col(2).dot(T.translation()) >= 0) return std::nullopt;  // seen from behind
  return TagPoseSolution{.T_camera_tag = T, .error_px = std::sqrt(r.squaredNorm() / 4)};
}

}  // namespace

std::array<Eigen::Vector3d, 4> tag_corners_m(double tag_size_m) {
  const double h = tag_size_m / 2;
  return {{{-h, h, 0}, {-h, -h, 0}, {h, -h, 0}, {h, h, 0}}};
}

std::vector<TagPoseSolution> tag_poses(const core::TagDetection& detection,
                                       const core::CameraModel& camera, double tag_size_m) {
  // Once out of the lens, straight lines are straight and the pinhole's derivatives hold.
  const core::CameraModel pinhole = camera.pinhole();
  Pixels pixels;
  for (std::size_t i = 0; i < 4; ++i) pixels[i] = camera.undistorted(detection.corner_px[i]);
  if (!is_front_of_square(pixels)) return {};
  const Corners corners = tag_corners_m(tag_size_m);
  const auto start = pose_of_homography(pixels, corners, pinhole);
  if (!start) return {};
  const auto first = refined(*start, pixels, corners, pinhole);
  if (!first) return {};
  const auto second = refined(mirrored(first->T_camera_tag), pixels, corners, pinhole);
  const auto apart = [&] {
    return Eigen::AngleAxisd(first->T_camera_tag.linear().transpose() *
                             second->T_camera_tag.linear())
        .angle();
  };
  if (!second || apart() < kSamePose_rad) return {*first};
  if (second->error_px < first->error_px) return {*second, *first};
  return {*first, *second};
}

}  // namespace nightjar::tracker
