#pragma once

#include <vector>

#include "esi/complementary_filter_config.h"
#include "esi/picture_filter.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {

/// Complementary filter (Scheerlinck et al., ACCV 2018): the log brightness L of a pixel
/// follows its events at once and the latest frame, L_aps = log(1 + frame / white), slowly:
/// L = beta L + (1 - beta) L_aps + p c at each event, beta = exp(-2 pi f dt). Without frames
/// L_aps is 0: a high-pass filter. Original: github.com/cedric-scheerlinck/
/// dvs_image_reconstruction (MIT), of which this is written anew.
///
/// Departures: the original brings all pixels up to the time of each picture and keeps that,
/// here looking changes nothing; exponentials compose, so pictures are the same. A frame acts
/// from the end of its exposure on, as in the original's offline mode. Not taken over: contrast
/// thresholds and a displayed range that calibrate themselves.
class ComplementaryFilter final : public Reconstructor {
 public:
  /// Throws std::invalid_argument for a config out of range, or a white that is not above
  /// its black.
  ComplementaryFilter(const ComplementaryFilterConfig& config, core::Resolution size);

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void take_frame(core::ApsFrame&& frame) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void clear(core::Time start) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  void follow_events(std::span<const PackedEvent> events);
  void follow_events_and_frame(std::span<const PackedEvent> events);
  void bring_up_to(std::uint32_t now_us);
  void draw_unfiltered(std::uint32_t now_us, std::span<std::uint8_t> gray) const;

  struct Cell {
    float log = 0;  ///< L at t_us.
    std::uint32_t t_us = 0;
  };
  /// What a pixel tends to, and how fast.
  struct Anchor {
    float log = 0;          ///< L_aps.
    float log2_per_us = 0;  ///< Minus 2 pi f, for powers of 2.
  };
  Anchor anchor(double brightness) const;

  ComplementaryFilterConfig config_;
  PictureFilter filter_;
  std::vector<Cell> cells_;
  std::vector<Anchor> anchors_;  ///< Of the latest frame, a pixel each.
  bool has_frame_ = false;
  /// While events may still come that are older than the latest frame: when it began to act.
  bool frame_is_ahead_ = false;
  std::uint32_t frame_us_ = 0;
};

}  // namespace nightjar::esi
