#include "sim/gauss_markov.h"

#include <cmath>

namespace nightjar::sim {

Eigen::Vector3d normal3(core::Random& random) {
  const double x = core::normal(random), y = core::normal(random), z = core::normal(random);
  return {x, y, z};
}

GaussMarkov::GaussMarkov(const Eigen::Vector3d& sigma, double correlation_s, core::Random random)
    : sigma_(sigma), correlation_s_(correlation_s), random_(random), value_(noise()) {}

Eigen::Vector3d GaussMarkov::noise() { return normal3(random_).cwiseProduct(sigma_); }

void GaussMarkov::advance(double dt_s) {
  const double keep = std::exp(-dt_s / correlation_s_);
  value_ = keep * value_ + std::sqrt(1.0 - keep * keep) * noise();
}

}  // namespace nightjar::sim
