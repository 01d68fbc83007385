#include "scenarios/frame_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "camera/gray_level.h"
#include "core/config_check.h"
#include "scenarios/event_stream.h"
#include "scenarios/network_steps.h"
#include "scenarios/reconstruct.h"
#include "scenarios/scored_method.h"

namespace nightjar::scenarios {
namespace {

void check(const ScoreOptions& options, const FrameChoice& choice) {
  core::check_range("fps", options.rate_hz, 0.01, 100000);
  core::check_range("from_s", choice.from_s, 0, kMostSeconds);
  core::check_range("until_s", options.until_s.value_or(kMostSeconds), 0, kMostSeconds);
  if (options.until_s && *options.until_s < choice.from_s)
    throw std::invalid_argument(fmt::format("until_s = {}, allowed from_s (--from) = {} to {}",
                                            *options.until_s, choice.from_s, kMostSeconds));
  core::check_range("max_exposure_ms", choice.max_exposure_ms, 0.001, 1e6);
}

core::Time middle_of(const core::ApsFrame& frame) {
  return frame.exposure_begin + (frame.exposure_end - frame.exposure_begin) / 2;
}

core::Image<std::uint8_t> eight_bits(const core::ApsFrame& frame) {
  const auto gray = camera::with_bits(frame.gray, frame.bits, 8);
  core::Image<std::uint8_t> out(gray.size());
  std::ranges::transform(gray.pixels(), out.pixels().begin(),
                         [](std::uint16_t level) { return static_cast<std::uint8_t>(level); });
  return out;
}

class FrameScoring {
 public:
  FrameScoring(camera::RecordingReader& events, camera::RecordingReader& frames,
               const ScoreOptions& options, const FrameChoice& choice);

  MethodScores run();

 private:
  void begin();
  bool next_frame();
  void take_events(core::Time until);
  void consider_frame(core::Time middle);
  void tell_progress() const;
  const std::string& first_fault() const;
  EmptyRecording empty(std::string why) const;
  EmptyRecording nothing_compared() const;
  MethodScores result() const;

  camera::RecordingReader& all_events_;
  camera::RecordingReader& frames_;
  const ScoreOptions& options_;
  const FrameChoice& choice_;
  core::Resolution size_;
  EventStream events_;
  std::deque<ScoredMethod> methods_;
  camera::RecordingPart part_;    ///< Of frames_ ...
  std::size_t next_in_part_ = 0;  ///< ... of which these have been taken.
  camera::RecordedFrame frame_;   ///< The present one.
  core::Time begin_{}, until_ = core::Time::max();
  core::Time done_{};  ///< All events up to here have been taken.
  FrameCount count_;
};

FrameScoring::FrameScoring(camera::RecordingReader& events, camera::RecordingReader& frames,
                           const ScoreOptions& options, const FrameChoice& choice)
    : all_events_(events),
      frames_(frames),
      options_(options),
      choice_(choice),
      size_(events.size()),
      events_(events) {
  esi::ReconstructorConfig config = options.reconstructor;
  for (const esi::Method method : options.methods) {
    config.method = method;
    methods_.emplace_back(config, size_);
  }
}

void FrameScoring::begin() {
  const auto first = events_.next_time();
  if (!first) throw empty("no events");
  begin_ = done_ = *first;
  if (options_.until_s) until_ = begin_ + core::from_seconds(*options_.until_s);
  for (ScoredMethod& method : methods_) method.begin(begin_);
}

bool FrameScoring::next_frame() {
  while (next_in_part_ == part_.frames.size()) {
    if (!frames_.next(part_)) return false;
    next_in_part_ = 0;
    tell_progress();
  }
  frame_ = std::move(part_.frames[next_in_part_++]);
  return true;
}

void FrameScoring::take_events(core::Time until) {
  const NetworkSteps steps(done_, std::max(done_, until), options_.rate_hz);
  for (auto events = events_.take_until(until); !events.empty();
       events = events_.take_until(until)) {
    for (ScoredMethod& method : methods_) method.take_events(events, steps);
    done_ = events.back().t;
    tell_progress();
  }
  for (ScoredMethod& method : methods_) method.advance_to(until);
  done_ = std::max(done_, until);
}

/// With all events up to the middle of its exposure taken.
void FrameScoring::consider_frame(core::Time middle) {
  if (middle < begin_ + core::from_seconds(choice_.from_s)) {
    ++count_.too_early;
  } else if (!events_.next_time()) {
    ++count_.after_events;
  } else if (frame_.exposure_end - frame_.exposure_begin >
             core::from_seconds(choice_.max_exposure_ms / 1000)) {
    ++count_.exposed_too_long;
  } else if (const auto gray = eight_bits(frame_); gray.size() != size_ || variance(gray) <= 0) {
    ++count_.unfit;
  } else {
    ++count_.compared;
    for (ScoredMethod& method : methods_) method.compare(middle, gray);
  }
}

void FrameScoring::tell_progress() const {
  const double all_s =
      std::min(events_.estimated_duration_s(), options_.until_s.value_or(kMostSeconds));
  options_.on_progress(all_s > 0 ? std::min(core::seconds(done_ - begin_) / all_s, 1.0) : 0.0);
}

/// Whichever of the two readers has come to it.
const std::string& FrameScoring::first_fault() const {
  return frames_.faults().any() ? frames_.faults().first : all_events_.faults().first;
}

/// A fault may be why: it goes with the message.
EmptyRecording FrameScoring::empty(std::string why) const {
  if (!first_fault().empty()) why += "; " + first_fault();
  return EmptyRecording(why);
}

EmptyRecording FrameScoring::nothing_compared() const {
  std::string why = to_text(count_);
  if (count_.exposed_too_long > 0)
    why += fmt::format("; a --max-exposure over {} ms takes those", choice_.max_exposure_ms);
  if (options_.until_s)
    why += fmt::format("; frames after --until {} are not counted", *options_.until_s);
  return empty(why);
}

MethodScores FrameScoring::result() const {
  MethodScores result{.methods = {}, .frames = count_, .first_fault = first_fault()};
  for (const ScoredMethod& method : methods_) result.methods.push_back(method.result());
  return result;
}

MethodScores FrameScoring::run() {
  begin();
  bool any = false;
  while (next_frame()) {
    any = true;
    const core::Time middle = middle_of(frame_);
    if (middle > until_) break;
    take_events(middle);
    consider_frame(middle);
    for (ScoredMethod& method : methods_) method.add_frame(frame_);
  }
  if (!any) throw empty("no frames to compare with; --reference PICTURE takes another");
  if (count_.compared == 0) throw nothing_compared();
  return result();
}

}  // namespace

MethodScores score_frames(camera::RecordingReader& events, camera::RecordingReader& frames,
                          const ScoreOptions& options, const FrameChoice& choice) {
  check(options, choice);
  if (const auto why = too_small(events.size()); !why.empty())
    throw EmptyRecording("sensor of " + why);
  return FrameScoring(events, frames, options, choice).run();
}

}  // namespace nightjar::scenarios
