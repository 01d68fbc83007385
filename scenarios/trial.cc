#include "scenarios/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "core/config_check.h"
#include "esi/make_network.h"
#include "esi/quality.h"
#include "scenarios/choice_text.h"
#include "scenarios/reconstructor_feed.h"
#include "scenarios/tag_score.h"
#include "sim/carried_camera.h"
#include "tracker/tag_detector.h"

namespace nightjar::scenarios {
namespace {

constexpr core::Time kScoredFrom{1'000'000};
constexpr double kRim_px = 12;
constexpr int kCompareEvery = 5;  // of the scored pictures: SSIM tells no more from all

/// A method at work on one sequence.
class Runner {
 public:
  Runner(const TrialEntry& entry, core::Resolution size, sim::CarryMotion motion,
         double illuminance_lux, std::uint64_t seed)
      : reconstructor_(esi::make_any_reconstructor(entry.config, size)), feed_(*reconstructor_) {
    score_.method = entry.name;
    score_.motion = motion;
    score_.illuminance_lux = illuminance_lux;
    score_.seed = seed;
  }

  void take(const sim::CarriedStep& step) {
    for (const core::ApsFrame& frame : step.frames) feed_.add_frame(frame);
    feed_.advance(step.packet.events, step.packet.end);
    reconstructor_->render(step.packet.end, picture_);
  }

  const core::Picture& picture() const { return picture_; }
  TrialScore& score() { return score_; }

 private:
  std::unique_ptr<esi::Reconstructor> reconstructor_;
  ReconstructorFeed feed_;
  core::Picture picture_;
  TrialScore score_;
};

/// What an ideal frame camera would show: white at the brightest pixel.
core::Image<std::uint8_t> ideal_picture(const core::Image<float>& luminance_lux) {
  const float brightest = std::ranges::max(luminance_lux.pixels());
  core::Image<std::uint8_t> gray(luminance_lux.size());
  std::ranges::transform(luminance_lux.pixels(), gray.pixels().begin(), [brightest](float lux) {
    return static_cast<std::uint8_t>(255.0f * lux / brightest + 0.5f);
  });
  return gray;
}

bool is_visible(const core::CameraModel& model, const core::Truth& truth, double tag_size_m) {
  const auto corners = project_tag(model, truth, tag_size_m);
  return corners && std::ranges::all_of(*corners, [&](const Eigen::Vector2d& corner) {
           return model.contains(corner, kRim_px);
         });
}

void score_tag(const TrialConfig& config, const core::CameraModel& model,
               const sim::CarriedStep& step, tracker::TagDetector& detector, Runner& runner) {
  const bool visible = is_visible(model, step.truth, config.tag.size_m);
  const TagScore found =
      score_tags(model, step.truth, config.tag, detector.detect(runner.picture()));
  runner.score().visible += visible;
  runner.score().detected += visible && found.detected;
  runner.score().false_detections += found.false_detections;
}

void run_sequence(const TrialConfig& config, sim::CarriedCamera& camera,
                  tracker::TagDetector& detector, std::vector<Runner>& runners) {
  const core::Time end = core::from_seconds(config.duration_s);
  int scored = 0;
  for (int picture = 1;; ++picture) {
    const sim::CarriedStep step = camera.next();
    for (Runner& runner : runners) runner.take(step);
    const bool is_scored = step.packet.end >= kScoredFrom && picture % config.score_every == 0;
    if (is_scored)
      for (Runner& runner : runners) score_tag(config, camera.model(), step, detector, runner);
    if (is_scored && scored++ % kCompareEvery == 0) {
      const auto ideal = ideal_picture(step.luminance_lux);
      for (Runner& runner : runners) {
        runner.score().ssim_sum += esi::compare(runner.picture().gray, ideal).ssim;
        ++runner.score().compared;
      }
    }
    if (step.packet.end >= end) return;
  }
}

}  // namespace

TrialCell trial_cell(const std::vector<TrialScore>& scores, const std::string& method,
                     sim::CarryMotion motion, double illuminance_lux) {
  TrialScore all;
  for (const TrialScore& score : scores) {
    if (score.method != method || score.motion != motion ||
        score.illuminance_lux != illuminance_lux)
      continue;
    all.visible += score.visible;
    all.detected += score.detected;
    all.false_detections += score.false_detections;
    all.compared += score.compared;
    all.ssim_sum += score.ssim_sum;
  }
  return {all.visible > 0 ? static_cast<double>(all.detected) / all.visible : 0.0,
          all.compared > 0 ? all.ssim_sum / all.compared : 0.0, all.false_detections};
}

std::vector<TrialScore> run_trial(const TrialConfig& config, const std::vector<TrialEntry>& entries,
                                  const TrialProgress& progress) {
  core::check_range("duration_s", config.duration_s, 1.1, 600.0);
  core::check_range("score_every", config.score_every, 1, 1000);
  if (config.motions.empty() || config.illuminances_lux.empty() || config.seeds.empty() ||
      entries.empty())
    throw std::invalid_argument("a trial needs a motion, an illuminance, a seed and a method");
  tracker::TagDetector detector(config.detector);
  std::vector<TrialScore> scores;
  const int all = static_cast<int>(config.motions.size() * config.illuminances_lux.size() *
                                   config.seeds.size());
  int done = 0;
  for (const std::uint64_t seed : config.seeds)
    for (const sim::CarryMotion motion : config.motions)
      for (const double lux : config.illuminances_lux) {
        progress(
            done++, all,
            fmt::format("{}, {} lux, seed {}", choice_name(motion, sim::kCarryMotions), lux, seed));
        sim::CarriedCamera camera(config.camera, config.sensor, config.renderer, config.model, lux,
                                  motion, seed);
        std::vector<Runner> runners;
        for (const TrialEntry& entry : entries)
          runners.emplace_back(entry, camera.model().size, motion, lux, seed);
        run_sequence(config, camera, detector, runners);
        for (Runner& runner : runners) scores.push_back(runner.score());
      }
  progress(all, all, "");
  return scores;
}

}  // namespace nightjar::scenarios
