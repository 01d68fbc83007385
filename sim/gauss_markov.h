#pragma once

#include <Eigen/Core>

#include "core/random.h"

namespace nightjar::sim {

/// Three standard normal draws.
Eigen::Vector3d normal3(core::Random& random);

/// A stationary first-order Gauss-Markov error in three axes.
class GaussMarkov {
 public:
  /// `sigma` is the stationary standard deviation of each axis.
  GaussMarkov(const Eigen::Vector3d& sigma, double correlation_s, core::Random random);
  const Eigen::Vector3d& value() const { return value_; }
  void advance(double dt_s);  ///< exact for any step

 private:
  Eigen::Vector3d noise();

  Eigen::Vector3d sigma_;
  double correlation_s_;
  core::Random random_;
  Eigen::Vector3d value_;
};

}  // namespace nightjar::sim
