#include "scenarios/board_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "camera/frame_source.h"
#include "camera/gray_level.h"
#include "scenarios/reconstruction.h"
#include "scenarios/recording_info.h"

namespace nightjar::scenarios {
namespace {

core::Image<std::uint8_t> to_gray(const core::Image<float>& intensity) {
  core::Image<std::uint8_t> gray(intensity.size());
  std::ranges::transform(intensity.pixels(), gray.pixels().begin(), [](float value) {
    return static_cast<std::uint8_t>(
        std::isfinite(value) ? std::lround(255 * std::clamp(value, 0.0f, 1.0f)) : 0);
  });
  return gray;
}

/// Where it is on the sensor, in 8 bits.
core::Image<std::uint8_t> to_gray(const camera::RecordedFrame& frame, core::Resolution size) {
  const core::Image<std::uint16_t> eight = camera::with_bits(frame.gray, frame.bits, 8);
  core::Image<std::uint8_t> gray(size);
  for (int y = 0; y < eight.height(); ++y)
    for (int x = 0; x < eight.width(); ++x)
      gray(frame.left_px + x, frame.top_px + y) = static_cast<std::uint8_t>(eight(x, y));
  return gray;
}

void look(BoardSearch& search, BoardFinder& finder, const core::Picture& picture,
          const std::string& name) {
  ++search.pictures;
  search.size = picture.gray.size();
  if (std::optional<BoardView> view = finder.find(picture)) {
    view->picture = name;
    search.views.push_back(*std::move(view));
  }
}

std::string time_name(core::Time since_begin) {
  return fmt::format("{:.3f} s", core::seconds(since_begin));
}

}  // namespace

BoardSearch search_pictures(const std::filesystem::path& folder, BoardFinder& finder,
                            const SearchProgress& on_progress) {
  const auto frames = camera::open_frames(folder, {.rate_hz = 1});  // asked for, of no matter
  BoardSearch search;
  for (core::Image<float> frame; frames->next(frame);) {
    look(search, finder, {{}, to_gray(frame)}, fmt::format("picture {}", search.pictures + 1));
    const double announced = std::max(1, frames->announced_frames());
    on_progress(std::min(1.0, static_cast<double>(search.pictures) / announced));
  }
  return search;
}

BoardSearch search_frames(camera::RecordingReader& recording, BoardFinder& finder,
                          const SearchProgress& on_progress) {
  BoardSearch search;
  std::optional<core::Time> begin;
  for (camera::RecordingPart part; recording.next(part);) {
    for (const camera::RecordedFrame& frame : part.frames) {
      if (!begin) begin = frame.exposure_begin;
      look(search, finder, {frame.exposure_end, to_gray(frame, recording.size())},
           time_name(frame.exposure_begin - *begin));
    }
    on_progress(recording.progress());
  }
  if (search.pictures == 0) throw EmptyRecording("the recording has no frames");
  search.warning = fault_text(recording.faults());
  return search;
}

BoardSearch search_events(camera::RecordingReader& recording, const ReconstructOptions& options,
                          BoardFinder& finder, const SearchProgress& on_progress) {
  ReconstructOptions mine = options;
  mine.on_progress = [&](double done_s, double end_s) {
    on_progress(std::clamp(done_s / std::max(end_s, 1e-6), 0.0, 1.0));
  };
  BoardSearch search;
  std::optional<core::Time> begin;
  const auto take = [&](const core::Picture& picture, auto) {
    if (!begin) begin = picture.t - core::from_seconds(1 / options.rate_hz);
    look(search, finder, picture, time_name(picture.t - *begin));
  };
  search.warning = warning(reconstruct(recording, mine, take));
  search.size = recording.size();
  return search;
}

}  // namespace nightjar::scenarios
