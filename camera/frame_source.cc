#include "camera/frame_source.h"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "camera/picture_folder.h"
#include "camera/video_file.h"
#include "core/config_check.h"

namespace nightjar::camera {
namespace {

constexpr double kLeastRateHz = 1e-3;  // a step of the emulator is at most an hour
constexpr double kMostRateHz = 1e6;    // a microsecond from frame to frame

void check(const FrameOptions& options) {
  if (options.rate_hz) core::check_range("fps", *options.rate_hz, kLeastRateHz, kMostRateHz);
  if (options.size) {
    core::check_range("size.width_px", options.size->width_px, 1, core::kMostSide_px);
    core::check_range("size.height_px", options.size->height_px, 1, core::kMostSide_px);
  }
  core::check_range("white", options.float_white, 1e-30, 1e30);
}

}  // namespace

std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                         const FrameOptions& options) {
  check(options);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return std::make_unique<PictureFolder>(path, options);
  if (!std::filesystem::exists(path, ignored))
    throw std::invalid_argument(fmt::format("{}: no such file or folder", path.string()));
  if (is_picture(path))
    throw std::invalid_argument(
        fmt::format("{}: one picture, expected a folder of them or a video", path.string()));
  auto video = std::make_unique<VideoFile>(path, options);
  core::check_range(path.string() + ": fps", video->rate_hz(), kLeastRateHz, kMostRateHz);
  return video;
}

}  // namespace nightjar::camera
