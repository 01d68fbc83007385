#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

enum class SpatialFilter { none, gaussian, bilateral };

inline constexpr core::Choices<SpatialFilter, 3> kSpatialFilters{
    {{"none", SpatialFilter::none},
     {"gaussian", SpatialFilter::gaussian},
     {"bilateral", SpatialFilter::bilateral}}};

/// Complementary filter of events and frames (Scheerlinck et al., ACCV 2018), and the
/// high-pass filter that it is without frames. Brightness is the original's: exp(L) - 1,
/// 0 for black and 1 for white in a frame.
struct ComplementaryFilterConfig {
  bool use_frames = true;      ///< Else, and before the first frame, the high-pass filter.
  double cutoff_hz = 0.5;      ///< f: how fast the frame takes over from the events.
  double high_pass_hz = 0.06;  ///< f without frames: how fast zero takes over.
  /// Adaptive cutoff without frames: each event first scales what its pixel holds by exp of
  /// minus this. So the cutoff of a pixel with r events a second is high_pass_hz +
  /// r high_pass_per_event / (2 pi); 0 = the same cutoff everywhere.
  double high_pass_per_event = 0.06;
  double contrast_on_log = 0.1;   ///< c of an ON event, natural log units.
  double contrast_off_log = 0.1;  ///< c of an OFF event.
  /// Of cutoff_hz, where the frame is black or white; 1 = not lowered, as the original does
  /// unless told to.
  double saturated_share = 0.1;
  double saturation_margin = 0.05;  ///< Brightness from black, or white, to the full cutoff.
  double black = -0.1;              ///< Brightness shown as 0.
  double white = 1.2;               ///< Brightness shown as 255.
  double high_pass_black = -0.5;    ///< The same without frames.
  double high_pass_white = 1.5;
  SpatialFilter filter = SpatialFilter::none;  ///< Of the picture, 5x5.
  double filter_sigma = 0.5;  ///< In pixels; bilateral: in 20 pixels and in 20 grey levels.

  template <class Visitor>
  void visit(Visitor& v) {
    constexpr const char* kComplementary = "dvs_image_reconstruction complementary_filter";
    constexpr const char* kHighPass = "dvs_image_reconstruction pure_event_reconstruction";
    const core::Origin complementary{kComplementary};
    const core::Origin complementary_number{kComplementary, core::kPureNumber};
    const core::Origin high_pass_number{kHighPass, core::kPureNumber};
    v.field("use_frames", use_frames);
    v.field("cutoff_hz", cutoff_hz, 0.0, 1000.0, complementary);
    v.field("high_pass_hz", high_pass_hz, 0.0, 1000.0, core::Origin{kHighPass});
    v.field("high_pass_per_event", high_pass_per_event, 0.0, 10.0, high_pass_number);
    v.field("contrast_on_log", contrast_on_log, 0.001, 2.0, complementary);
    v.field("contrast_off_log", contrast_off_log, 0.001, 2.0, complementary);
    v.field("saturated_share", saturated_share, 0.0, 1.0, complementary_number);
    v.field("saturation_margin", saturation_margin, 0.0, 0.5, complementary_number);
    v.field("black", black, -100.0, 100.0, complementary_number);
    v.field("white", white, -100.0, 100.0, complementary_number);
    v.field("high_pass_black", high_pass_black, -100.0, 100.0, high_pass_number);
    v.field("high_pass_white", high_pass_white, -100.0, 100.0, high_pass_number);
    v.choice("filter", filter, kSpatialFilters);
    v.field("filter_sigma", filter_sigma, 0.001, 100.0,
            core::Origin{"assumption: visible, yet keeps edges", core::kPureNumber});
  }
};

}  // namespace nightjar::esi
