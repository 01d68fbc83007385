#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/image.h"
#include "esi/memory_cell.h"

namespace nightjar::esi {

/// Shows a frame of the active pixels where little has happened since its shutter opened, and
/// leaves the events' picture where much has.
///
/// With g the share of pixels, of those within 8 px along either axis, that have had an event
/// since then, the frame counts w = (1 - g^2) / (1 + (g / 0.25)^2): all where there was none,
/// nothing where each had one. So a frame that is blurred, or true no longer, gives way to the
/// events that tell of it.
///
/// The value B of a pixel that has had one is brought up to date, B exp(0.15 n), by its balance n
/// of ON and OFF events, which fades with 15 /s: about those since a frame 40 ms ago. The frame is
/// shown as the network shows the scene, in deviations from its mean: 0.75 of levels_per_sigma for
/// each, since the network's answer is the fainter the less sure it is. Where the frame deviates by
/// less than 0.15 of its mean, that stands for the deviation, as in training.
///
/// A frame that is noise, as one of 4 ms is in the dark, or all alike is not shown: half the mean
/// squared difference of neighbours, which is noise's variance, has to be below 0.2 of all there
/// is. Frames exposed for long enough have 0.02 to 0.12, sharp ones of 4 ms in 10 lux 0.97.
///
/// The numbers were chosen on two tuning seeds of the trial and four recordings
/// (docs/decisions/0009).
class FrameBlend {
 public:
  static constexpr int kReach_px = 8;

  /// `levels_per_sigma` as EsiNetConfig has it.
  FrameBlend(core::Resolution size, double levels_per_sigma);

  /// Forgets the frame.
  void clear() { has_frame_ = false; }

  /// Takes the place of the frame before. As Reconstructor::add_frame() lets it pass.
  void take(core::ApsFrame frame);

  /// Blends the frame into `gray`, the events' picture at `t`, not before the last event. Not one
  /// that began more than 17.9 minutes ago. The same bits on every processor.
  void blend(std::span<const MemoryCell> cells, core::Time t, core::Image<std::uint8_t>& gray);

 private:
  /// A frame's value v is shown as 127.5 + gain v - offset; a gain of 0: not at all.
  struct Levels {
    float gain;
    float offset;
  };
  Levels find_levels() const;
  void look_at(std::span<const MemoryCell> cells, core::Time t);
  void add_to_columns(int row, std::int16_t times);
  void count_nearby();
  void find_shares();
  void blend_pixels(Levels levels, core::Image<std::uint8_t>& gray) const;

  double levels_per_sigma_;
  bool has_frame_ = false;
  core::ApsFrame frame_;
  std::optional<Levels> levels_;    ///< Of the frame, once they are asked for.
  core::Image<float> gain_log2_;    ///< What events have made of a pixel's brightness.
  core::Image<std::uint8_t> busy_;  ///< 1 where an event was since the shutter opened.
  /// Busy pixels by column, of the rows within reach; at either end kReach_px columns with none.
  std::vector<std::int16_t> columns_;
  std::vector<std::int16_t> nearby_;  ///< A row's busy pixels within reach.
  std::vector<float> per_column_;     ///< 1 / how many columns are within reach.
  core::Image<float> share_;          ///< Of busy pixels within reach.
};

}  // namespace nightjar::esi
