#include "scenarios/trial_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scenarios/choice_text.h"
#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

std::string cell_text(const TrialCell& cell) {
  return fmt::format("{:5.1f} / {:.3f}", 100.0 * cell.detection_rate, cell.ssim);
}

}  // namespace

std::string trial_table(const TrialConfig& config, const std::vector<TrialEntry>& entries,
                        const std::vector<TrialScore>& scores) {
  std::vector<std::vector<std::string>> rows{{"sequences"}};
  std::vector<TrialCell> sums(entries.size());
  for (const TrialEntry& entry : entries) rows[0].push_back(entry.name);
  for (const sim::CarryMotion motion : config.motions)
    for (const double lux : config.illuminances_lux) {
      rows.push_back({fmt::format("{} {} lux", choice_name(motion, sim::kCarryMotions), lux)});
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const TrialCell cell = trial_cell(scores, entries[i].name, motion, lux);
        rows.back().push_back(cell_text(cell));
        sums[i].detection_rate += cell.detection_rate;
        sums[i].ssim += cell.ssim;
        sums[i].false_detections += cell.false_detections;
      }
    }
  const double cells = static_cast<double>(config.motions.size() * config.illuminances_lux.size());
  rows.push_back({"mean"});
  std::vector<std::string> false_detections{"false detections"};
  for (const TrialCell& sum : sums) {
    rows.back().push_back(cell_text({sum.detection_rate / cells, sum.ssim / cells, 0}));
    false_detections.push_back(fmt::format("{:5}", sum.false_detections));
  }
  rows.push_back(false_detections);
  return "detection rate in % / SSIM\n" + text_table(rows);
}

std::string trial_json(const std::vector<TrialScore>& scores) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const TrialScore& score : scores)
    list.push_back({{"method", score.method},
                    {"motion", choice_name(score.motion, sim::kCarryMotions)},
                    {"illuminance_lux", score.illuminance_lux},
                    {"seed", score.seed},
                    {"visible", score.visible},
                    {"detected", score.detected},
                    {"false_detections", score.false_detections},
                    {"ssim", score.compared > 0 ? score.ssim_sum / score.compared : 0.0}});
  return list.dump(2) + '\n';
}

}  // namespace nightjar::scenarios
