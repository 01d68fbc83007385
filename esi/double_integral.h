#pragma once

#include <algorithm>
#include <vector>

#include "esi/double_integral_config.h"
#include "esi/event_history.h"
#include "esi/reconstructor.h"
#include "esi/sharpness.h"

namespace nightjar::esi {

/// exp(c n) for whole numbers n of events, tabulated between two of them. |c n| counts as 350
/// at most, so that sums of these stay finite.
class Growth {
 public:
  /// What n is within. No scene spans that many thresholds: a broken pixel may.
  static constexpr int kMostLevel = 1 << 15;
  static int level(int n) { return std::clamp(n, -kMostLevel, kMostLevel); }

  /// `least` <= 0 <= `greatest`, both within kMostLevel.
  void tabulate(double contrast_log, int least, int greatest);
  /// exp(c level), for levels within those bounds.
  double operator()(int level) const { return table_[static_cast<std::size_t>(level - least_)]; }

 private:
  int least_ = 0;
  std::vector<double> table_;
};

/// What EDI and FEDI share, which is all but the way they walk an exposure's events
/// (Pan et al., CVPR 2019, eq. 5 to 8). A blurred frame is the mean of the latent pictures over its
/// exposure: B = (1/T) integral of L(f) exp(c E(t)) dt, E(t) the signed number of events
/// from f to t. With f the begin of the exposure that gives L(f), and any later picture is
/// L(t) = L(f) exp(c E(t)). A picture shows L from 0 to 1, the frame's black and white.
///
/// A pixel of value 0 counts as half a step of the frame, since no factor brightens 0. Before
/// the first frame L is 1/2 all over at the start.
///
/// c is the config's, or found anew for each frame with events, where log L in the middle of
/// the exposure is sharpest: the first maximum of sharpness.h within bounds, and the c before
/// if there is none. The first, since far too large a c gives pictures of spikes,
/// sharp in their way. The paper weighs total variation against an edge map of the events;
/// this measure has no weight to choose.
///
/// A frame whose exposure reaches back beyond the events kept is treated as if nothing had
/// happened before them.
class DoubleIntegral : public Reconstructor {
 public:
  /// Events kept at most, 64 MB of them; more in history_s and the oldest go.
  static constexpr std::size_t kMostKept = std::size_t{1} << 23;

  /// c of the present pictures, natural log units.
  double contrast_log() const { return contrast_log_; }
  /// Events that went for want of room since the last reset.
  std::uint64_t dropped() const { return history_.dropped(); }

 protected:
  /// Its events are ordered and within [begin, end).
  struct Exposure {
    std::span<const PackedEvent> events;
    std::uint32_t begin_us = 0;
    std::uint32_t end_us = 0;
  };

  /// Methods call reset() last in their constructors.
  DoubleIntegral(const DoubleIntegralConfig& config, core::Resolution size, const char* path);

  /// The exposure that means() is asked about next; its events stay until then.
  virtual void expose(const Exposure& exposure) = 0;

  /// Sets each pixel with events, at least in the rows given, to fast_log2 of the mean of
  /// growth(E(t)) over the exposure, summed in order of time. Those without keep their 0.
  virtual void log_means(const Growth& growth, SharpnessRows rows, core::Image<float>& log2) = 0;

  void clear(core::Time start) override;

 private:
  void integrate(std::span<const PackedEvent> events) override;
  void take_frame(core::ApsFrame&& frame) override;
  void draw(core::Time t, core::Image<std::uint8_t>& gray) override;
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override;

  Exposure find_exposure(const core::ApsFrame& frame);
  void count_events(const Exposure& exposure);
  void take_brightness(const core::ApsFrame& frame);
  double sharpness_at(double contrast_log);

  DoubleIntegralConfig config_;
  EventHistory history_;
  double contrast_log_ = 0;
  std::vector<float> start_log2_;  ///< Of L(f).
  std::vector<float> count_;       ///< E from f to the last event. Floats stop at 2^24.
  std::vector<float> count_to_middle_;
  int least_level_ = 0;  ///< Of E over the exposure, any pixel.
  int greatest_level_ = 0;
  Growth growth_;
  core::Image<float> still_;   ///< 1 where the exposure has no event, else 0.
  core::Image<float> latent_;  ///< log2 L in the middle of the exposure, in a search.
  core::Image<float> log_mean_;
};

}  // namespace nightjar::esi
