#pragma once

#include <vector>

#include "esi/esi_config.h"
#include "esi/leaky_sum.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Event-based single integration, the ESI paper's Algorithm 2: each event is added,
/// then the sum decays by the time since the pixel's last event, then it is clamped.
/// Nothing decays between a pixel's last event and the picture. Options of EsiConfig
/// change the order, or let the picture show the decay up to its own time.
///
/// In floats and vectors: pictures are within one grey level of the listing in doubles
/// (esi_reference.h), and the same to the bit on every processor.
class Esi final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Esi(const EsiConfig& config, core::Resolution size);

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void integrate_run(EventRun& run) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  LeakySum sum_;
  bool decay_at_picture_;
  std::vector<SumCell> cells_;
};

}  // namespace nightjar::esi
