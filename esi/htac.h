#pragma once

#include <array>
#include <vector>

#include "esi/htac_config.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Event-driven sparse convolution with decay, after De et al., "High-throughput asynchronous
/// convolutions" (2022). No code of theirs was found; this is written from the description:
/// an event adds a 3x3 Gaussian kernel, sum 1, times p c to the pixels around it that lie on
/// the sensor; every pixel decays by exp(-t / tau), at all times, and is clamped when an event
/// touches it.
///
/// One rate holds for all pixels, so the decay is a change of unit: a pixel keeps
/// S exp((t - epoch) / tau), which does not change between its events. Only what is
/// added and the clamp grow with time, and the epoch moves on before they grow too large.
class Htac final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Htac(const HtacConfig& config, core::Resolution size);

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  void move_epoch(std::uint32_t to_us);
  std::uint32_t index(std::uint32_t pixel) const;

  HtacConfig config_;
  std::array<float, 9> kernel_{};  ///< Times c, row by row.
  float log2_per_us_;
  std::uint32_t most_us_;  ///< The epoch is no longer ago than this at any event.
  std::uint32_t stride_;   ///< Of cells_: the sensor with a border of 1 pixel.
  /// floor(pixel / width) = pixel * reciprocal_ >> shift_.
  std::uint64_t reciprocal_;
  int shift_;
  std::vector<float> cells_;
  std::uint32_t epoch_us_ = 0;
};

}  // namespace nightjar::esi
