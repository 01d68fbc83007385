#pragma once

#include <vector>

#include "esi/accumulator_config.h"
#include "esi/leaky_sum.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// iniVation's Accumulator (dv-processing 1.x): a pixel's potential decays towards neutral
/// up to each of its events, which then adds or takes away, within bounds; the picture
/// shows every potential as decayed up to its own time, [least, greatest] as 0 to 255.
///
/// Synchronous decay: events only add, and each picture decays all potentials together,
/// by the time since the latest picture so far.
///
/// Step decay: all return to neutral after a picture, here when the next event comes, so
/// that looking again shows the same.
class Accumulator final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range, which includes `least` not
  /// below `greatest` and `neutral` outside of them.
  Accumulator(const AccumulatorConfig& config, core::Resolution size);

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void integrate_run(EventRun& run) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  void decay_all(core::Time t);

  AccumulatorConfig config_;
  LeakySum sum_;  ///< Of what a potential is above neutral.
  std::vector<SumCell> cells_;
  core::Time decayed_to_{};  ///< Synchronous decay: the latest picture.
  bool drawn_ = false;       ///< Since the last event.
};

}  // namespace nightjar::esi
