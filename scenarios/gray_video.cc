#include "scenarios/gray_video.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/part_file.h"

namespace nightjar::scenarios {
namespace {

int even(int side_px) { return side_px + side_px % 2; }

}  // namespace

int video_frames(const std::filesystem::path& path) {
  cv::VideoCapture video(path.string());
  return video.isOpened() ? cvRound(video.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
}

struct GrayVideo::Impl {
  std::filesystem::path path;
  std::filesystem::path part;  ///< Empty once it has its name.
  cv::VideoWriter writer;
  int frames = 0;
};

GrayVideo::GrayVideo(std::filesystem::path path, core::Resolution size, double rate_hz)
    : impl_(std::make_unique<Impl>()) {
  impl_->part = core::part_name(path);
  impl_->path = std::move(path);
  if (!impl_->writer.open(impl_->part.string(), cv::VideoWriter::fourcc('a', 'v', 'c', '1'),
                          rate_hz, {even(size.width_px), even(size.height_px)}))
    throw std::runtime_error(
        fmt::format("{}: no video of {}x{} px and {:.6g} pictures/s can be written",
                    impl_->path.string(), size.width_px, size.height_px, rate_hz));
}

GrayVideo::~GrayVideo() {
  if (impl_->part.empty()) return;
  impl_->writer.release();
  std::error_code ignored;
  std::filesystem::remove(impl_->part, ignored);
}

void GrayVideo::add(const core::Image<std::uint8_t>& gray) {
  const cv::Mat mat(gray.height(), gray.width(), CV_8U,
                    const_cast<std::uint8_t*>(gray.pixels().data()));
  cv::Mat bgr;
  cv::cvtColor(mat, bgr, cv::COLOR_GRAY2BGR);
  cv::copyMakeBorder(bgr, bgr, 0, gray.height() % 2, 0, gray.width() % 2, cv::BORDER_CONSTANT);
  impl_->writer.write(bgr);
  ++impl_->frames;
}

void GrayVideo::finish() {
  impl_->writer.release();
  // The writer itself says nothing of a full disk or a codec that gives up.
  const int readable = impl_->frames > 0 ? video_frames(impl_->part) : 0;
  if (readable == 0 || readable != impl_->frames)
    throw std::runtime_error(fmt::format("{}: {} pictures can be read of {} written",
                                         impl_->path.string(), readable, impl_->frames));
  std::filesystem::rename(impl_->part, impl_->path);
  impl_->part.clear();
}

}  // namespace nightjar::scenarios
