#pragma once

#include <cstdint>

namespace nightjar::sim {

/// What the pixels did so far.
struct EmulatorCounts {
  std::uint64_t signal = 0;  ///< Threshold crossings, leak included.
  std::uint64_t shot = 0;    ///< Shot noise.
  std::uint64_t hot = 0;     ///< Hot pixels.
  // Inputs corrected.
  std::uint64_t negative_radiance = 0;
  std::uint64_t not_finite_radiance = 0;  ///< NaN, infinite or beyond 1e20.
};

}  // namespace nightjar::sim
