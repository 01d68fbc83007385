#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

/// Several ESI sums a pixel, joined by a small convolution network (docs/decisions/0009).
/// Nothing in it is tuned to a scene; only what it is made of and shown like can be chosen.
struct EsiNetConfig {
  bool use_frames = true;          ///< Show them where little has happened since: FrameBlend.
  double levels_per_sigma = 45.0;  ///< Grey levels for one deviation of the scene's luminance.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("use_frames", use_frames);
    v.field("levels_per_sigma", levels_per_sigma, 1.0, 255.0,
            {"assumption: +-2.8 deviations fill the range", core::kPureNumber});
  }
};

}  // namespace nightjar::esi
