#include "scenarios/recording_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/config_check.h"

namespace nightjar::scenarios {
namespace {

const cv::Vec3b kOn(0, 200, 0), kOff(0, 0, 230);  // blue, green, red
constexpr int kMostSide_px = 4096;                // keeps the picture within memory
constexpr double kGray = 96;                      // where there is no frame
constexpr double kDimmed = 0.6;                   // so that events stand out

/// How long after an event a frame exposed before it may come in the file.
constexpr core::Time kFrameDelay = std::chrono::milliseconds(100);

/// What is to be seen, gathered from the recording.
struct Gathered {
  std::optional<core::Time> first, last;  ///< Of all events read.
  core::Image<std::uint8_t> events;       ///< A Mark each.
  std::uint64_t event_count = 0;
  std::optional<camera::RecordedFrame> frame;
};

enum Mark : std::uint8_t { kNone, kMarkOff, kMarkOn };

Gathered gather(camera::RecordingReader& recording, const RecordingViewOptions& options) {
  Gathered gathered;
  gathered.events = core::Image<std::uint8_t>(recording.size());
  const core::Time at = core::from_seconds(options.at_s);
  const core::Time end = at + core::from_seconds(options.span_s);
  for (camera::RecordingPart part; recording.next(part);) {
    if (options.on_progress) options.on_progress(recording.progress());
    if (!gathered.first && !part.events.empty()) gathered.first = part.events.front().t;
    for (const core::Event& event : part.events) {
      gathered.last = event.t;
      const core::Time t = event.t - *gathered.first;
      if (t < at || t >= end) continue;
      gathered.events(event.x, event.y) = event.on ? kMarkOn : kMarkOff;
      ++gathered.event_count;
    }
    for (camera::RecordedFrame& frame : part.frames)
      if (!gathered.first || frame.exposure_end <= *gathered.first + end)
        gathered.frame = std::move(frame);
    if (!part.events.empty() && part.events.front().t > *gathered.first + end + kFrameDelay) break;
  }
  return gathered;
}

void check(const Gathered& gathered, const RecordingViewOptions& options) {
  if (!gathered.first) throw std::invalid_argument("the recording has no events");
  const double duration_s = core::seconds(*gathered.last - *gathered.first);
  if (options.at_s > duration_s)
    throw std::invalid_argument(
        fmt::format("at = {} s, allowed 0 to {:.6f} s", options.at_s, duration_s));
}

/// The frame where it was on the sensor, in colour and 8 bits.
cv::Mat picture_of(const std::optional<camera::RecordedFrame>& frame, core::Resolution size) {
  cv::Mat picture(size.height_px, size.width_px, CV_8UC3, cv::Scalar::all(frame ? 0 : kGray));
  if (!frame) return picture;
  const double scale = 255.0 / ((1 << frame->bits) - 1);
  for (int y = 0; y < frame->gray.height(); ++y)
    for (int x = 0; x < frame->gray.width(); ++x)
      picture.at<cv::Vec3b>(frame->top_px + y, frame->left_px + x) =
          cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(scale * frame->gray(x, y)));
  return picture;
}

}  // namespace

RecordingView draw_recording(camera::RecordingReader& recording,
                             const RecordingViewOptions& options) {
  core::check_range("at", options.at_s, 0, 1e9);
  core::check_range("span", options.span_s, 1e-6, 1e6);
  core::check_range("width_px", recording.size().width_px, 1, kMostSide_px);
  core::check_range("height_px", recording.size().height_px, 1, kMostSide_px);
  const Gathered gathered = gather(recording, options);
  check(gathered, options);
  const cv::Mat frame = picture_of(gathered.frame, recording.size());
  cv::Mat events = gathered.frame ? cv::Mat(frame * kDimmed) : frame.clone();
  for (int y = 0; y < events.rows; ++y)
    for (int x = 0; x < events.cols; ++x)
      if (const std::uint8_t mark = gathered.events(x, y); mark != kNone)
        events.at<cv::Vec3b>(y, x) = mark == kMarkOn ? kOn : kOff;
  if (gathered.frame) cv::hconcat(events, frame, events);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", events, png);
  return {{png.begin(), png.end()}, gathered.event_count, gathered.frame.has_value()};
}

}  // namespace nightjar::scenarios
