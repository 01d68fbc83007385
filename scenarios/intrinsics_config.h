#pragma once

#include "core/config_check.h"
#include "core/event.h"

namespace nightjar::scenarios {

/// What `nightjar calibrate` writes about a camera: a pinhole (pixel centres at whole
/// numbers) behind a lens, see core::CameraModel and core::Lens.
struct IntrinsicsConfig {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double k3 = 0;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("width_px", width_px, 1, core::kMostSide_px);
    v.field("height_px", height_px, 1, core::kMostSide_px);
    v.field("fx_px", fx_px, 1.0, 1e6);
    v.field("fy_px", fy_px, 1.0, 1e6);
    v.field("cx_px", cx_px, -1e5, 1e5);
    v.field("cy_px", cy_px, -1e5, 1e5);
    v.field("k1", k1, -100.0, 100.0, {"", core::kPureNumber});
    v.field("k2", k2, -1000.0, 1000.0, {"", core::kPureNumber});
    v.field("p1", p1, -10.0, 10.0, {"", core::kPureNumber});
    v.field("p2", p2, -10.0, 10.0, {"", core::kPureNumber});
    v.field("k3", k3, -10000.0, 10000.0, {"", core::kPureNumber});
  }
};

}  // namespace nightjar::scenarios
