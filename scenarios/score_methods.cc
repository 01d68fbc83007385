#include "scenarios/score_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "camera/recording.h"
#include "scenarios/choice_text.h"
#include "scenarios/frame_scores.h"
#include "scenarios/method_needs.h"
#include "scenarios/reconstruct.h"
#include "scenarios/recordings.h"

namespace nightjar::scenarios {
namespace {

/// The picture at the end, of the method that `options` name.
Reconstruction reconstruct_all(const std::filesystem::path& path, core::Resolution size,
                               const ReconstructOptions& options) {
  const auto recording = open_recording(path, size);
  Reconstruction result = reconstruct(*recording, options, [](auto&&...) {});
  if (result.faults.events_outside > 0)
    throw std::invalid_argument(fmt::format("{}: events outside {}x{}, the reference's size",
                                            path.string(), size.width_px, size.height_px));
  return result;
}

MethodScore score_method(const std::filesystem::path& path,
                         const core::Image<std::uint8_t>& reference,
                         const ReconstructOptions& options, std::string& first_fault) {
  const esi::Method method = options.reconstructor.method;
  MethodScore result;
  result.method = choice_name(method, esi::kMethods);
  result.skipped = lacks_weights(options.reconstructor);
  if (!result.skipped.empty()) return result;
  const Reconstruction made = reconstruct_all(path, reference.size(), options);
  first_fault = made.faults.first;
  result.saw_frames = made.frames > 0 && is_given_frames(options.reconstructor);
  if (result.saw_frames || !starts_from_frames(method))
    result.score = score(made.last.gray, reference);
  else
    result.skipped = made.frames_refused > 0 ? "needs frames: " + made.first_refusal
                                             : "needs frames, the recording holds none";
  return result;
}

}  // namespace

MethodScores score_against_picture(const std::filesystem::path& recording,
                                   const core::Image<std::uint8_t>& reference,
                                   const ScoreOptions& options) {
  if (const auto why = too_small(reference.size()); !why.empty())
    throw std::invalid_argument("reference of " + why);
  ReconstructOptions each;
  each.reconstructor = options.reconstructor;
  each.rate_hz = options.rate_hz;
  each.until_s = options.until_s;
  MethodScores scores;
  each.on_progress = [&](double done_s, double end_s) {
    const double share = end_s > 0 ? std::min(done_s / end_s, 1.0) : 1.0;
    options.on_progress((static_cast<double>(scores.methods.size()) + share) /
                        static_cast<double>(options.methods.size()));
  };
  for (const esi::Method method : options.methods) {
    each.reconstructor.method = method;
    scores.methods.push_back(score_method(recording, reference, each, scores.first_fault));
  }
  return scores;
}

MethodScores score_against_frames(const std::filesystem::path& recording,
                                  std::optional<core::Resolution> size, const ScoreOptions& options,
                                  const FrameChoice& choice) {
  const auto events = open_recording(recording, size);
  const auto frames = open_recording(recording, events->size());
  try {
    return score_frames(*events, *frames, options, choice);
  } catch (const EmptyRecording& error) {
    throw std::invalid_argument(fmt::format("{}: {}", recording.string(), error.what()));
  }
}

}  // namespace nightjar::scenarios
