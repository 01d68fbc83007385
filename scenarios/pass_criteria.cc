#include "scenarios/pass_criteria.h"

#include <fmt/format.h>

namespace nightjar::scenarios {

std::vector<std::string> failed_criteria(const PassCriteria& criteria, const Summary& summary) {
  std::vector<std::string> failed;
  // Written so that a NaN fails too.
  const auto at_most = [&](const char* name, std::optional<double> value, double limit) {
    if (!value)
      failed.push_back(fmt::format("{} = none, wanted at most {}", name, limit));
    else if (!(*value <= limit))
      failed.push_back(fmt::format("{} = {:.4g}, wanted at most {}", name, *value, limit));
  };
  if (summary.crashed) failed.push_back("crashed = true, wanted false");
  if (summary.ugv_collided) failed.push_back("ugv_collided = true, wanted false");
  if (criteria.require_landed && !summary.landed) failed.push_back("landed = false, wanted true");
  if (summary.landed)
    at_most("touchdown_error_m", summary.touchdown_error_m, criteria.max_touchdown_error_m);
  if (!(summary.detection_rate >= criteria.min_detection_rate))
    failed.push_back(fmt::format("detection_rate = {:.4g}, wanted at least {}",
                                 summary.detection_rate, criteria.min_detection_rate));
  if (summary.false_detections > criteria.max_false_detections)
    failed.push_back(fmt::format("false_detections = {}, wanted at most {}",
                                 summary.false_detections, criteria.max_false_detections));
  at_most("relative_position_rmse_m", summary.relative_position_rmse_m,
          criteria.max_relative_position_rmse_m);
  return failed;
}

}  // namespace nightjar::scenarios
