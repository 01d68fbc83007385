#include "scenarios/reconstruct.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/config_check.h"
#include "esi/make_network.h"
#include "scenarios/choice_text.h"
#include "scenarios/method_needs.h"
#include "scenarios/reconstructor_feed.h"
#include "tracker/tag_detector.h"

namespace nightjar::scenarios {
namespace {

/// Longer without events, the pictures between are left out: a clock that jumped ahead by
/// years must not fill the disk.
constexpr core::Time kMostPause = std::chrono::minutes(1);

class Reconstructing {
 public:
  Reconstructing(camera::RecordingReader& recording, const ReconstructOptions& options,
                 const TakePicture& take)
      : recording_(recording),
        options_(options),
        take_(take),
        reconstructor_(esi::make_any_reconstructor(options.reconstructor, recording.size())),
        feed_(*reconstructor_),
        uses_frames_(is_given_frames(options.reconstructor)) {
    if (options.detector) detector_.emplace(*options.detector);
  }

  Reconstruction run();

 private:
  void take_part();
  std::span<const core::Event> in_window(std::span<const core::Event> events);
  void hand_over_frame_before();
  void take_events(std::span<const core::Event> events);
  void skip_pause(core::Time next_event);
  void make_picture(core::Time t);
  void finish();
  void tell_progress() const;

  core::Time due() const {
    return begin_ + core::from_seconds(static_cast<double>(next_) / options_.rate_hz);
  }

  camera::RecordingReader& recording_;
  const ReconstructOptions& options_;
  const TakePicture& take_;
  std::unique_ptr<esi::Reconstructor> reconstructor_;
  ReconstructorFeed feed_;
  std::optional<tracker::TagDetector> detector_;
  camera::RecordingPart part_;
  std::optional<core::ApsFrame> frame_before_;  ///< The newest that ends before it begins.
  core::Picture picture_;
  bool uses_frames_;  ///< Else unfit frames are no matter to complain about.
  bool begun_ = false, ended_ = false;
  core::Time begin_{}, until_ = core::Time::max(), last_{};
  std::int64_t next_ = 1;  ///< Which picture is due next.
  Reconstruction result_;
};

std::span<const core::Event> Reconstructing::in_window(std::span<const core::Event> events) {
  if (!begun_ && !events.empty()) {
    begun_ = true;
    if (options_.until_s) until_ = events.front().t + core::from_seconds(*options_.until_s);
    begin_ = last_ = events.front().t + core::from_seconds(options_.from_s.value_or(0));
    reconstructor_->reset(begin_);
  }
  const auto first = std::ranges::lower_bound(events, begin_, {}, &core::Event::t);
  const auto end = std::ranges::upper_bound(events, until_, {}, &core::Event::t);
  ended_ = end != events.end();
  return first < end ? std::span(first, end) : std::span<const core::Event>{};
}

void Reconstructing::take_part() {
  const auto events = in_window(part_.events);
  if (!uses_frames_) part_.frames.clear();
  for (core::ApsFrame& frame : part_.frames) {
    if (begun_ && frame.exposure_end > begin_) {
      hand_over_frame_before();
      feed_.add_frame(std::move(frame));
    } else {
      frame_before_ = std::move(frame);
    }
  }
  if (!events.empty()) hand_over_frame_before();
  take_events(events);
}

void Reconstructing::hand_over_frame_before() {
  if (frame_before_) feed_.add_frame(std::move(*frame_before_));
  frame_before_.reset();
}

void Reconstructing::take_events(std::span<const core::Event> events) {
  result_.events += events.size();
  while (!events.empty()) {
    skip_pause(events.front().t);
    const auto later = std::ranges::upper_bound(events, due(), {}, &core::Event::t);
    const auto count = static_cast<std::size_t>(later - events.begin());
    if (count == 0) {
      feed_.advance({}, due());
      make_picture(due());
      continue;
    }
    last_ = events[count - 1].t;
    feed_.advance(events.first(count), last_);
    events = events.subspan(count);
  }
}

void Reconstructing::skip_pause(core::Time next_event) {
  if (next_event - last_ <= kMostPause || due() >= next_event) return;
  const double steps = core::seconds(next_event - begin_) * options_.rate_hz;
  const std::int64_t before = next_;
  next_ = std::max(next_, static_cast<std::int64_t>(std::ceil(steps)));
  result_.pictures_left_out += static_cast<std::uint64_t>(next_ - before);
}

void Reconstructing::make_picture(core::Time t) {
  reconstructor_->render(t, picture_);
  std::vector<core::TagDetection> tags;
  if (detector_) tags = detector_->detect(picture_);
  take_(picture_, tags);
  ++next_;
  ++result_.pictures;
  result_.tags += tags.size();
  result_.pictures_with_tag += !tags.empty();
  tell_progress();
}

void Reconstructing::tell_progress() const {
  if (!options_.on_progress || !begun_) return;
  const double done_s = core::seconds(last_ - begin_);
  double end_s = done_s / std::max(recording_.progress(), 1e-6);
  if (options_.until_s) end_s = std::min(end_s, core::seconds(until_ - begin_));
  options_.on_progress(done_s, end_s);
}

void Reconstructing::finish() {
  if (result_.events == 0)
    throw EmptyRecording(begun_ ? "no events between --from and --until" : "no events");
  if (ended_) {  // there are events beyond
    skip_pause(until_);
    last_ = until_;
  }
  feed_.advance({}, last_);
  while (due() <= last_) make_picture(due());
  reconstructor_->render(last_, result_.last);
}

Reconstruction Reconstructing::run() {
  const auto start = std::chrono::steady_clock::now();
  while (!ended_ && recording_.next(part_)) {
    take_part();
    tell_progress();
  }
  finish();
  result_.method = choice_name(options_.reconstructor.method, esi::kMethods);
  result_.size = recording_.size();
  result_.rate_hz = options_.rate_hz;
  result_.begin = begin_;
  result_.end = last_;
  result_.frames = feed_.frames();
  result_.frames_refused = feed_.frames_refused();
  result_.first_refusal = feed_.first_refusal();
  result_.searched = detector_.has_value();
  result_.faults = recording_.faults();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  result_.wall_time_s = wall.count();
  return std::move(result_);
}

}  // namespace

Reconstruction reconstruct(camera::RecordingReader& recording, const ReconstructOptions& options,
                           const TakePicture& take) {
  core::check_range("fps", options.rate_hz, 0.01, 100000);
  core::check_range("from_s", options.from_s.value_or(0), 0, kMostSeconds);
  core::check_range("until_s", options.until_s.value_or(kMostSeconds), options.from_s.value_or(0),
                    kMostSeconds);
  return Reconstructing(recording, options, take).run();
}

}  // namespace nightjar::scenarios
