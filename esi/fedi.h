#pragma once

#include "esi/double_integral.h"

namespace nightjar::esi {

/// FEDI (Lin et al., "Fast event-based double integral for real-time robotics", 2023,
/// arXiv 2305.05925): the events of the exposure are sorted by pixel once, into how long each
/// pixel stayed at which level, and for each c every pixel's stays are walked once, one after
/// the other in memory. The pictures are EDI's.
class Fedi final : public DoubleIntegral {
 public:
  /// Throws std::invalid_argument for a config out of range.
  Fedi(const DoubleIntegralConfig& config, core::Resolution size);

 private:
  void expose(const Exposure& exposure) override;
  void log_means(const Growth& growth, SharpnessRows rows, core::Image<float>& log2) override;

  void make_room(const Exposure& exposure);

  /// A pixel between two of its events, or between one and an end of the exposure.
  struct Stay {
    std::uint32_t duration_us;
    int level;
  };
  /// Where a pixel's next stay goes, and since when it lasts.
  struct Cursor {
    std::uint32_t next = 0;
    std::uint32_t t_us = 0;
    int level = 0;
  };
  /// A pixel with events: its stays are those from here to the next run's.
  struct Run {
    std::uint32_t pixel;
    std::uint32_t begin;
  };

  double duration_us_ = 0;
  std::vector<Cursor> cursors_;  ///< A pixel each.
  std::vector<Stay> stays_;
  std::vector<Run> runs_;                 ///< In order of pixels; one more at the end.
  std::vector<std::uint32_t> first_run_;  ///< Of each row; then where the rows end.
};

}  // namespace nightjar::esi
