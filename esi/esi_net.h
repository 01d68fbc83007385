#pragma once

#include <vector>

#include "esi/block_output.h"
#include "esi/edge_mixture.h"
#include "esi/esi_net_config.h"
#include "esi/frame_blend.h"
#include "esi/memory_cell.h"
#include "esi/reconstructor.h"
#include "esi/shading.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// Sums of events with seven different memories a pixel, joined at picture time by a small
/// convolution network that was trained on the simulator (docs/decisions/0009).
///
/// No one decay suits hovering and fast flight, darkness and light: a long memory keeps the
/// picture and the noise, a short one loses both. Here each pixel has several, and the
/// network, with weights that EdgeMixture chooses, sees from all of them, the neighbours' too, what
/// is signal: edges. How bright the surfaces between them are, Shading adds. All in whole numbers
/// but the choice, in doubles of one order: every processor gives the same picture. Where little
/// happens, and there are frames of the active pixels, FrameBlend shows those.
class EsiNet final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range.
  EsiNet(const EsiNetConfig& config, core::Resolution size);

  /// What the network would see in a picture at `t`, not before the last event: each pixel a
  /// block of 2x2 of the sensor's, row by row, with kPixelFeatures values each; an odd side's
  /// last pixel stands in for its missing neighbour. To train by.
  const ChannelImage& features(core::Time t);

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void integrate_run(EventRun& run) override;
  void take_frame(core::ApsFrame&& frame) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  void quantise_features(std::uint32_t now_us);

  bool use_frames_;
  std::vector<MemoryCell> cells_;
  ChannelImage features_;
  EdgeMixture edges_;
  ChannelImage first_, second_;
  Shading shading_;
  BlockOutput output_;
  FrameBlend frame_blend_;
};

}  // namespace nightjar::esi
