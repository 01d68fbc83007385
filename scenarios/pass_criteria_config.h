#pragma once

namespace nightjar::scenarios {

/// What a run must reach to pass. Whatever these say, a UAV that crashes and a
/// UGV that hits an obstacle fail it.
struct PassCriteria {
  bool require_landed = true;
  double max_touchdown_error_m = 0.10;  ///< judged when it landed
  double min_detection_rate = 0.74;     ///< share of pictures; the ESI paper's figure
  int max_false_detections = 0;
  double max_relative_position_rmse_m = 0.5;  ///< without any valid estimate it fails

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("require_landed", require_landed);
    v.field("max_touchdown_error_m", max_touchdown_error_m, 0.0, 10.0);
    v.field("min_detection_rate", min_detection_rate, 0.0, 1.0);
    v.field("max_false_detections", max_false_detections, 0, 1000000);
    v.field("max_relative_position_rmse_m", max_relative_position_rmse_m, 0.0, 100.0);
  }
};

}  // namespace nightjar::scenarios
