#include "esi/complementary_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "esi/best_instructions.h"
#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

constexpr double kLog2PerRadian_us = -2 * std::numbers::pi * std::numbers::log2e * 1e-6;

void check_white(const char* path, double black, double white) {
  constexpr double kLeastRange = 0.001;
  core::check_range(path, white, black + kLeastRange, 100.0);
}

/// `log` after `dt_us` without events.
[[gnu::always_inline]] inline float decayed(float log, float to_log, float log2_per_us,
                                            float dt_us) {
  return to_log + (log - to_log) * fast_exp2(log2_per_us * dt_us);
}

/// From log brightness to grey levels.
struct Display {
  float black;
  float per_level;

  Display(double least, double greatest)
      : black(static_cast<float>(1.0 + least)),
        per_level(static_cast<float>(255.0 / (greatest - least))) {}

  [[gnu::always_inline]] std::uint8_t operator()(float log) const {
    return to_gray((fast_exp2(log * kLog2E) - black) * per_level);
  }
};

}  // namespace

ComplementaryFilter::ComplementaryFilter(const ComplementaryFilterConfig& config,
                                         core::Resolution size)
    : Reconstructor(size), config_(config), filter_(config.filter, config.filter_sigma) {
  core::check_config(config, "complementary_filter");
  check_white("complementary_filter.white", config.black, config.white);
  check_white("complementary_filter.high_pass_white", config.high_pass_black,
              config.high_pass_white);
  if (config.use_frames) anchors_.resize(static_cast<std::size_t>(size.pixels()));
  reset();
}

void ComplementaryFilter::clear(core::Time start) {
  cells_.assign(static_cast<std::size_t>(size().pixels()), Cell{0, low_us(start)});
  has_frame_ = frame_is_ahead_ = false;
}

void ComplementaryFilter::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  if (most_us == 0) frame_is_ahead_ = false;
  const bool is_ahead = static_cast<std::int32_t>(frame_us_ - now_us) > 0;
  if (!(frame_is_ahead_ && is_ahead)) limit_times(cells_, now_us, most_us);
}

void ComplementaryFilter::integrate(std::span<const PackedEvent> events) {
  while (frame_is_ahead_ && !events.empty()) {
    PackedEvent e = events.front();
    frame_is_ahead_ = static_cast<std::int32_t>(frame_us_ - e.t_us) > 0;
    if (!frame_is_ahead_) break;
    e.t_us = frame_us_;  // its pixel has been brought up to there already
    follow_events_and_frame({&e, 1});
    events = events.subspan(1);
  }
  if (has_frame_)
    follow_events_and_frame(events);
  else
    follow_events(events);
}

void ComplementaryFilter::follow_events(std::span<const PackedEvent> events) {
  const auto log2_per_us = static_cast<float>(config_.high_pass_hz * kLog2PerRadian_us);
  const auto left = static_cast<float>(std::exp(-config_.high_pass_per_event));
  const float steps[] = {static_cast<float>(-config_.contrast_off_log),
                         static_cast<float>(config_.contrast_on_log)};
  for (const PackedEvent& e : events) {
    Cell& cell = cells_[e.pixel()];
    const float beta = fast_exp2(log2_per_us * static_cast<float>(e.t_us - cell.t_us)) * left;
    cell = {cell.log * beta + steps[e.pixel_on & 1u], e.t_us};
  }
}

void ComplementaryFilter::follow_events_and_frame(std::span<const PackedEvent> events) {
  const float steps[] = {static_cast<float>(-config_.contrast_off_log),
                         static_cast<float>(config_.contrast_on_log)};
  for (const PackedEvent& e : events) {
    Cell& cell = cells_[e.pixel()];
    const Anchor& to = anchors_[e.pixel()];
    const auto dt_us = static_cast<float>(e.t_us - cell.t_us);
    cell = {decayed(cell.log, to.log, to.log2_per_us, dt_us) + steps[e.pixel_on & 1u], e.t_us};
  }
}

// The original's recalibrate_cutoff_frequency_array: from saturated_share at the very end of
// the log range to the full cutoff where the margin ends.
ComplementaryFilter::Anchor ComplementaryFilter::anchor(double brightness) const {
  const double log = std::log1p(brightness);
  const double margin = config_.saturation_margin;
  double soundness = 1;  // 0 where saturated
  if (brightness < margin) soundness = log / std::log1p(margin);
  if (brightness > 1 - margin)
    soundness = std::log(2 / (1 + brightness)) / std::log(2 / (2 - margin));
  const double share = config_.saturated_share + (1 - config_.saturated_share) * soundness;
  return {static_cast<float>(log),
          static_cast<float>(config_.cutoff_hz * share * kLog2PerRadian_us)};
}

void ComplementaryFilter::bring_up_to(std::uint32_t now_us) {
  const auto log2_per_us = static_cast<float>(config_.high_pass_hz * kLog2PerRadian_us);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Anchor to = has_frame_ ? anchors_[i] : Anchor{0, log2_per_us};
    const float dt_us = to_float(now_us - cells_[i].t_us);
    cells_[i] = {decayed(cells_[i].log, to.log, to.log2_per_us, dt_us), now_us};
  }
}

void ComplementaryFilter::take_frame(core::ApsFrame&& frame) {
  if (!config_.use_frames) return;
  const core::Time previous =
      frame_is_ahead_ ? last() + core::Time(frame_us_ - low_us(last())) : last();
  const core::Time end = std::min(frame.exposure_end, last() + core::Time(kMostAge_us));
  frame_us_ = low_us(std::max(end, previous));
  bring_up_to(frame_us_);
  has_frame_ = frame_is_ahead_ = true;

  std::array<Anchor, 1024> anchors;
  const int values = 1 << frame.bits;
  for (int value = 0; value < values; ++value)
    anchors[static_cast<std::size_t>(value)] = anchor(value / (values - 1.0));
  std::ranges::transform(frame.gray.pixels(), anchors_.begin(),
                         [&](std::uint16_t value) { return anchors[value]; });
}

void ComplementaryFilter::draw(core::Time t, core::Image<std::uint8_t>& gray) {
  std::uint32_t now_us = low_us(t);
  if (frame_is_ahead_ && static_cast<std::int32_t>(frame_us_ - now_us) > 0) now_us = frame_us_;
  draw_unfiltered(now_us, gray.pixels());
  filter_.apply(gray);
}

void ComplementaryFilter::draw_unfiltered(std::uint32_t now_us,
                                          std::span<std::uint8_t> gray) const {
  const std::size_t count = cells_.size();
  const Cell* cells = cells_.data();
  std::uint8_t* out = gray.data();
  if (has_frame_) {
    const Display display(config_.black, config_.white);
    const Anchor* anchors = anchors_.data();
    with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
      for (std::size_t i = 0; i < count; ++i)
        out[i] = display(decayed(cells[i].log, anchors[i].log, anchors[i].log2_per_us,
                                 to_float(now_us - cells[i].t_us)));
    });
  } else {
    const Display display(config_.high_pass_black, config_.high_pass_white);
    const auto log2_per_us = static_cast<float>(config_.high_pass_hz * kLog2PerRadian_us);
    with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
      for (std::size_t i = 0; i < count; ++i)
        out[i] = display(decayed(cells[i].log, 0, log2_per_us, to_float(now_us - cells[i].t_us)));
    });
  }
}

}  // namespace nightjar::esi
