#pragma once

#include "esi/double_integral.h"

namespace nightjar::esi {

/// EDI as its equation says: all events of the exposure in order of time, each going to its
/// pixel's integral, once for every c that is tried.
class Edi final : public DoubleIntegral {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Edi(const DoubleIntegralConfig& config, core::Resolution size);

 private:
  void expose(const Exposure& exposure) override { exposure_ = exposure; }
  void log_means(const Growth& growth, SharpnessRows rows, core::Image<float>& log2) override;

  struct Cell {
    double integral_us = 0;
    std::uint32_t t_us = 0;
    int level = 0;
  };

  Exposure exposure_;
  std::vector<Cell> cells_;
};

}  // namespace nightjar::esi
