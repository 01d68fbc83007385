#include "scenarios/scored_method.h"

#include <algorithm>
#include <cassert>

#include "esi/make_network.h"
#include "esi/make_reconstructor.h"
#include "scenarios/choice_text.h"
#include "scenarios/method_needs.h"

namespace nightjar::scenarios {

ScoredMethod::ScoredMethod(const esi::ReconstructorConfig& config, core::Resolution size)
    : config_(config) {
  result_.method = choice_name(config.method, esi::kMethods);
  result_.skipped = lacks_weights(config);
  if (!result_.skipped.empty()) return;
  reconstructor_ = esi::make_any_reconstructor(config, size);
  feed_.emplace(*reconstructor_);
}

void ScoredMethod::begin(core::Time t) {
  if (reconstructor_) reconstructor_->reset(t);
}

void ScoredMethod::add_frame(const core::ApsFrame& frame) {
  if (reconstructor_ && is_given_frames(config_)) feed_->add_frame(frame);
}

void ScoredMethod::take_events(std::span<const core::Event> events, const NetworkSteps& steps) {
  if (!reconstructor_ || events.empty()) return;
  if (esi::is_network(config_.method))
    take_network_events(events, steps);
  else
    feed_->advance(events, events.back().t);
}

void ScoredMethod::take_network_events(std::span<const core::Event> events,
                                       const NetworkSteps& steps) {
  while (!events.empty()) {
    const core::Time end = steps.step_end(events.front().t);
    if (step_end_ && *step_end_ != end) reconstructor_->render(*step_end_, picture_);
    step_end_ = end;
    const auto later = std::ranges::upper_bound(events, end, {}, &core::Event::t);
    const auto count = static_cast<std::size_t>(later - events.begin());
    assert(count > 0);  // the steps cover all events
    feed_->advance(events.first(count), events[count - 1].t);
    events = events.subspan(count);
  }
}

void ScoredMethod::advance_to(core::Time t) {
  if (reconstructor_) feed_->advance({}, t);
}

void ScoredMethod::compare(core::Time t, const core::Image<std::uint8_t>& reference) {
  if (!reconstructor_) return;
  reconstructor_->render(t, picture_);
  step_end_.reset();
  result_.frames.push_back({t, score(picture_.gray, reference)});
  result_.saw_frames = feed_->frames() > 0;
}

MethodScore ScoredMethod::result() const {
  MethodScore result = result_;
  if (!reconstructor_) return result;
  if (!starts_from_frames(config_.method) || result.saw_frames) {
    result.score = mean_score(result.frames);
    return result;
  }
  result.frames.clear();
  result.skipped = feed_->frames_refused() > 0 ? "needs frames: " + feed_->first_refusal()
                                               : "needs a frame before the last one compared";
  return result;
}

}  // namespace nightjar::scenarios
