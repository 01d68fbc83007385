#include "core/lens.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace nightjar::core {
namespace {

// Brown 1966, "Decentering distortion of lenses"; coefficients as OpenCV's calib3d counts them.

double radial_factor(const Lens& l, double r2) { return 1 + r2 * (l.k1 + r2 * (l.k2 + r2 * l.k3)); }

/// Derivative of r * radial_factor(r^2) by r.
double radial_slope(const Lens& l, double r2) {
  return 1 + r2 * (3 * l.k1 + r2 * (5 * l.k2 + r2 * 7 * l.k3));
}

/// Whether the seen radius grows all the way from the axis to r: a cubic in r^2 is least at
/// an end or where its derivative, 3 k1 + 10 k2 s + 21 k3 s^2, is 0.
bool grows_up_to(const Lens& l, double r2) {
  std::array<double, 2> turns{};  // 0: none
  if (l.k3 != 0) {
    const double root = std::sqrt(100 * l.k2 * l.k2 - 252 * l.k1 * l.k3);  // NaN: none either
    turns = {(-10 * l.k2 + root) / (42 * l.k3), (-10 * l.k2 - root) / (42 * l.k3)};
  } else if (l.k2 != 0) {
    turns[0] = -0.3 * l.k1 / l.k2;
  }
  for (const double s : turns)
    if (s > 0 && s < r2 && !(radial_slope(l, s) > 0)) return false;
  return radial_slope(l, r2) > 0;
}

Eigen::Vector2d seen_at(const Lens& l, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  return radial_factor(l, r2) * p + Eigen::Vector2d(2 * l.p1 * x * y + l.p2 * (r2 + 2 * x * x),
                                                    l.p1 * (r2 + 2 * y * y) + 2 * l.p2 * x * y);
}

Eigen::Matrix2d derivative(const Lens& l, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double factor_by_r2 = l.k1 + r2 * (2 * l.k2 + r2 * 3 * l.k3);
  Eigen::Matrix2d J = 2 * factor_by_r2 * p * p.transpose();
  J.diagonal().array() += radial_factor(l, r2);
  const double cross = 2 * (l.p1 * x + l.p2 * y);
  J(0, 0) += 2 * l.p1 * y + 6 * l.p2 * x;
  J(0, 1) += cross;
  J(1, 0) += cross;
  J(1, 1) += 6 * l.p1 * y + 2 * l.p2 * x;
  return J;
}

}  // namespace

bool Lens::is_ideal() const { return *this == Lens{}; }

std::optional<Eigen::Vector2d> Lens::distort(const Eigen::Vector2d& ideal) const {
  if (!grows_up_to(*this, ideal.squaredNorm())) return std::nullopt;
  return seen_at(*this, ideal);
}

// Newton from the seen point, or from nearer to the axis where the lens shows nothing there. A
// polynomial that bends both ways (k1 > 0 > k3) throws single steps beyond its turn or past the
// goal: halved until they stay inside and come nearer, which some length always does.
std::optional<Eigen::Vector2d> Lens::undistort(const Eigen::Vector2d& seen) const {
  constexpr int kIterations = 50;  // 4 to 6 are the rule; near the turn it takes more
  constexpr int kHalvings = 100;
  constexpr double kClose = 1e-12;
  const auto inside = [&](const Eigen::Vector2d& p) { return grows_up_to(*this, p.squaredNorm()); };
  Eigen::Vector2d p = seen;
  for (int i = 0; i < kHalvings && !inside(p); ++i) p *= 0.5;
  for (int i = 0; i < kIterations && inside(p); ++i) {
    const Eigen::Vector2d error = seen_at(*this, p) - seen;
    if (error.norm() < kClose) return p;
    Eigen::Vector2d step = derivative(*this, p).inverse() * error;
    const auto is_bad = [&] {
      return !inside(p - step) || (seen_at(*this, p - step) - seen).norm() >= error.norm();
    };
    for (int k = 0; k < kHalvings && is_bad(); ++k) step *= 0.5;
    p -= step;
  }
  return std::nullopt;
}

}  // namespace nightjar::core
