#pragma once

#include <vector>

#include "esi/config.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Event-based single integration, the ESI paper's Algorithm 2 to the letter: each
/// event is added, then the sum decays by the time since the pixel's last event, then
/// it is clamped. Nothing decays between a pixel's last event and the picture.
class Esi final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Esi(const EsiConfig& config, core::Resolution size);

  void process(std::span<const core::Event> events) override;
  void render(core::Time t, core::Picture& picture) override;
  void reset() override;

 private:
  /// d(t) of eq. 4.
  float decay(core::Time dt) const;

  /// A pixel's S and T, side by side since every event touches both.
  struct Cell {
    float sum_log = 0;
    std::int64_t last_us = 0;
  };

  EsiConfig config_;
  core::Resolution size_;
  std::vector<Cell> cells_;
  core::Time last_{};
};

}  // namespace nightjar::esi
