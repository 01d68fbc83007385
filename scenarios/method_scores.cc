#include "scenarios/method_scores.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Score& score) {
  return {{"mse", score.quality.mse},   {"psnr_db", score.quality.psnr_db},  // null where infinite
          {"ssim", score.quality.ssim}, {"explained", score.explained},
          {"gain", score.quality.gain}, {"offset_levels", score.quality.offset_levels}};
}

Json json_of(const MethodScore& method) {
  Json json = {{"method", method.method}};
  if (!method.score) {
    json["skipped"] = method.skipped;
    return json;
  }
  json["saw_frames"] = method.saw_frames;
  json.update(json_of(*method.score));
  for (const FrameScore& frame : method.frames) {
    Json each = {{"time_us", frame.t.count()}};
    each.update(json_of(frame.score));
    json["frames"].push_back(each);
  }
  return json;
}

Json json_of(const FrameCount& count) {
  return {{"compared", count.compared},
          {"left_out",
           {{"too_early", count.too_early},
            {"after_events", count.after_events},
            {"exposed_too_long", count.exposed_too_long},
            {"unfit", count.unfit}}}};
}

std::vector<std::string> row_of(const MethodScore& method) {
  if (!method.score) return {method.method, "-", "-", "-", "-", "-", "skipped: " + method.skipped};
  const esi::Quality& quality = method.score->quality;
  return {method.method,
          fmt::format("{:.1f}", quality.mse),
          fmt::format("{:.2f}", quality.psnr_db),
          fmt::format("{:.4f}", quality.ssim),
          fmt::format("{:.4f}", method.score->explained),
          fmt::format("{:.3f}", quality.gain),
          method.saw_frames ? "events, frames" : "events"};
}

}  // namespace

double variance(const core::Image<std::uint8_t>& picture) {
  double sum = 0, sum_of_squares = 0;
  for (const double value : picture.pixels()) {
    sum += value;
    sum_of_squares += value * value;
  }
  // Whole numbers so far, exact in a double.
  const auto pixels = static_cast<double>(picture.pixels().size());
  return (sum_of_squares - sum * sum / pixels) / pixels;
}

Score score(const core::Image<std::uint8_t>& picture, const core::Image<std::uint8_t>& reference) {
  const esi::Quality quality = esi::compare(picture, reference);
  const double all = variance(reference);
  return {quality, all > 0 ? std::max(1 - quality.mse / all, 0.0) : 0.0};
}

std::string too_small(core::Resolution size) {
  if (std::min(size.width_px, size.height_px) >= kLeastSide_px) return {};
  return fmt::format("{}x{} px, allowed from {}x{} px", size.width_px, size.height_px,
                     kLeastSide_px, kLeastSide_px);
}

std::optional<Score> mean_score(const std::vector<FrameScore>& frames) {
  if (frames.empty()) return std::nullopt;
  const auto mean = [&](const auto& number) {
    double sum = 0;
    for (const FrameScore& frame : frames) sum += number(frame.score);
    return sum / static_cast<double>(frames.size());
  };
  const auto of_quality = [&](double esi::Quality::*number) {
    return mean([&](const Score& score) { return score.quality.*number; });
  };
  return Score{{.gain = of_quality(&esi::Quality::gain),
                .offset_levels = of_quality(&esi::Quality::offset_levels),
                .mse = of_quality(&esi::Quality::mse),
                .psnr_db = of_quality(&esi::Quality::psnr_db),
                .ssim = of_quality(&esi::Quality::ssim)},
               mean([](const Score& score) { return score.explained; })};
}

std::string to_text(const FrameCount& count) {
  std::uint64_t left_out = 0;
  std::vector<std::string> reasons;
  const auto add = [&](std::uint64_t frames, const char* reason) {
    left_out += frames;
    if (frames > 0) reasons.push_back(fmt::format("{} {}", frames, reason));
  };
  add(count.too_early, "too early");
  add(count.after_events, "after the last event");
  add(count.exposed_too_long, "exposed for too long");
  add(count.unfit, "of part of the sensor or of one grey level");
  std::string text =
      fmt::format("{} frame{} compared", count.compared, count.compared == 1 ? "" : "s");
  if (left_out > 0) text += fmt::format(", {} left out: {}", left_out, fmt::join(reasons, ", "));
  return text;
}

std::string to_table(const MethodScores& scores) {
  std::vector<std::vector<std::string>> rows = {
      {"method", "MSE", "PSNR dB", "SSIM", "explained", "gain", "made of"}};
  for (const MethodScore& method : scores.methods) rows.push_back(row_of(method));
  std::string text = text_table(rows);
  if (scores.frames) text += to_text(*scores.frames) + '\n';
  return text;
}

std::string to_json(const MethodScores& scores) {
  Json json;
  if (scores.frames) json["frames"] = json_of(*scores.frames);
  json["methods"] = Json::array();
  for (const MethodScore& method : scores.methods) json["methods"].push_back(json_of(method));
  return json.dump(2) + '\n';
}

}  // namespace nightjar::scenarios
