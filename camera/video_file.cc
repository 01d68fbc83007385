#include "camera/video_file.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

namespace nightjar::camera {

struct VideoFile::Decoder {
  cv::VideoCapture video;
  cv::Mat frame;
};

VideoFile::VideoFile(const std::filesystem::path& path, const FrameOptions& options)
    : name_(path.string()),
      decoder_(std::make_unique<Decoder>()),
      converter_(options.float_white, options.size) {
  // FFmpeg alone: other backends would take a name with % for a folder of pictures.
  cv::VideoCapture& video = decoder_->video;
  if (!video.open(name_, cv::CAP_FFMPEG))
    throw std::invalid_argument(fmt::format("{}: cannot be read as a video", name_));
  rate_hz_ = options.rate_hz.value_or(video.get(cv::CAP_PROP_FPS));
  const double frames = video.get(cv::CAP_PROP_FRAME_COUNT);
  announced_frames_ = frames >= 1 && frames < 1e9 ? static_cast<int>(std::lround(frames)) : 0;
}

VideoFile::~VideoFile() = default;

bool VideoFile::next(core::Image<float>& intensity) {
  if (!decoder_->video.read(decoder_->frame)) return false;
  converter_.convert(decoder_->frame, name_, intensity);
  return true;
}

}  // namespace nightjar::camera
