#include "scenarios/method_scores.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "camera/recording.h"
#include "scenarios/choice_text.h"
#include "scenarios/reconstruct.h"
#include "scenarios/recordings.h"
#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

/// Of a method that is a network without weights.
bool lacks_weights(const esi::ReconstructorConfig& config, esi::Method method) {
  return (method == esi::Method::firenet && config.firenet.weights.empty()) ||
         (method == esi::Method::e2vid && config.e2vid.weights.empty());
}

bool starts_from_frames(esi::Method method) {
  return method == esi::Method::edi || method == esi::Method::fedi;
}

MethodScore score(const std::filesystem::path& path, const core::Image<std::uint8_t>& reference,
                  const MethodScoresOptions& options, esi::Method method) {
  MethodScore score;
  score.method = choice_name(method, esi::kMethods);
  if (lacks_weights(options.reconstructor, method)) {
    score.skipped = fmt::format("no weights: reconstructor.{}.weights", score.method);
    return score;
  }
  ReconstructOptions reconstruct_options;
  reconstruct_options.reconstructor = options.reconstructor;
  reconstruct_options.reconstructor.method = method;
  reconstruct_options.rate_hz = options.rate_hz;
  reconstruct_options.until_s = options.until_s;
  const auto recording = open_recording(path, reference.size());
  const Reconstruction result = reconstruct(*recording, reconstruct_options, [](auto&&...) {});
  if (result.faults.events_outside > 0)
    throw std::invalid_argument(fmt::format("{}: events outside {}x{}, the reference's size",
                                            path.string(), reference.width(), reference.height()));
  if (starts_from_frames(method) && result.frames == 0)
    score.skipped = "needs frames, the recording holds none";
  else
    score.quality = esi::compare(result.last.gray, reference);
  return score;
}

}  // namespace

std::vector<MethodScore> score_methods(const std::filesystem::path& recording,
                                       const core::Image<std::uint8_t>& reference,
                                       const MethodScoresOptions& options) {
  std::vector<MethodScore> scores;
  for (const esi::Method method : options.methods)
    scores.push_back(score(recording, reference, options, method));
  return scores;
}

std::string to_table(const std::vector<MethodScore>& scores) {
  std::vector<std::vector<std::string>> rows = {{"method", "MSE", "PSNR dB", "SSIM", "gain", ""}};
  for (const MethodScore& s : scores) {
    if (s.quality)
      rows.push_back({s.method, fmt::format("{:.1f}", s.quality->mse),
                      fmt::format("{:.2f}", s.quality->psnr_db),
                      fmt::format("{:.4f}", s.quality->ssim),
                      fmt::format("{:.3f}", s.quality->gain), ""});
    else
      rows.push_back({s.method, "-", "-", "-", "-", "skipped: " + s.skipped});
  }
  return text_table(rows);
}

std::string to_json(const std::vector<MethodScore>& scores) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MethodScore& s : scores) {
    nlohmann::ordered_json json = {{"method", s.method}};
    if (s.quality) {
      json["mse"] = s.quality->mse;
      json["psnr_db"] = s.quality->psnr_db;  // null where infinite
      json["ssim"] = s.quality->ssim;
      json["gain"] = s.quality->gain;
      json["offset_levels"] = s.quality->offset_levels;
    } else {
      json["skipped"] = s.skipped;
    }
    list.push_back(json);
  }
  return list.dump(2) + '\n';
}

}  // namespace nightjar::scenarios
