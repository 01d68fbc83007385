#include "scenarios/video.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "msg/channels.h"
#include "scenarios/gray_video.h"
#include "scenarios/video_panes.h"

namespace nightjar::scenarios {
namespace {

constexpr int kFramesPerSecond = 25;
constexpr core::Time kFrameInterval{1'000'000 / kFramesPerSecond};
constexpr int kCaptionHeight = 40;
const cv::Scalar kWhite(255, 255, 255), kFound(80, 230, 80);  // BGR

cv::Mat bgr(const Pane& pane) {
  cv::Mat out;
  const cv::Mat rgb(pane.height(), pane.width(), CV_8UC3,
                    const_cast<sim::Rgb*>(pane.pixels().data()));
  cv::cvtColor(rgb, out, cv::COLOR_RGB2BGR);
  return out;
}

void write(cv::Mat& picture, const std::string& text, cv::Point at) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.62, cv::Scalar(0, 0, 0), 4,
              cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.62, kWhite, 1, cv::LINE_AA);
}

/// Pixel centres lie at whole numbers in the sensor and in the pane.
cv::Point in_pane(const Eigen::Vector2d& sensor_px) {
  const Eigen::Vector2d p = kPaneScale * (sensor_px + Eigen::Vector2d(0.5, 0.5));
  return {cvRound(p.x() - 0.5), cvRound(p.y() - 0.5)};
}

void outline(cv::Mat& pane, const core::TagDetection& tag) {
  for (std::size_t i = 0; i < tag.corner_px.size(); ++i)
    cv::line(pane, in_pane(tag.corner_px[i]), in_pane(tag.corner_px[(i + 1) % 4]), kFound, 2,
             cv::LINE_AA);
  write(pane, std::to_string(tag.id), in_pane(tag.corner_px[2]));
}

std::string caption(const PictureRecord& record) {
  const Eigen::Vector3d apart =
      record.truth.uav.p_world_body_m - record.truth.T_world_tag.translation();
  return fmt::format("{:5.2f} s   UGV {}   UAV {}   {:.2f} m above the tag, {:.2f} m aside",
                     core::seconds(record.truth.t), record.truth.course_phase,
                     to_string(record.mission_phase), apart.z(), apart.head<2>().norm());
}

}  // namespace

struct Video::Impl {
  OutputFolder& folder;
  core::Resolution sensor;
  core::Resolution pane;
  cv::VideoWriter writer;
  core::Image<std::uint8_t> frame;  // of the active pixels
  core::Image<std::uint8_t> picture;
  std::vector<core::Event> events;  // since the last video frame
  Pane chase;
  core::Time next_due;
  int frames_written;

  cv::Mat compose(const PictureRecord& record) const;
};

Video::Video(msg::Bus& bus, OutputFolder& folder, const core::CameraModel& camera)
    : impl_(new Impl{folder,
                     camera.size,
                     {kPaneScale * camera.size.width_px, kPaneScale * camera.size.height_px},
                     {},
                     {},
                     {},
                     {},
                     {},
                     kFrameInterval,
                     0}) {
  impl_->chase = Pane(impl_->pane);
  const std::string path = folder.part(kVideoFile).string();
  const cv::Size size(2 * impl_->pane.width_px, 2 * impl_->pane.height_px + kCaptionHeight);
  if (!impl_->writer.open(path, cv::VideoWriter::fourcc('a', 'v', 'c', '1'), kFramesPerSecond,
                          size))
    throw std::runtime_error("cannot write the video " + path);
  Impl& impl = *impl_;
  bus.subscribe(msg::kApsFrame,
                [&impl](const core::ApsFrame& frame) { impl.frame = gray_8_bit(frame); });
  bus.subscribe(msg::kPicture,
                [&impl](const core::Picture& picture) { impl.picture = picture.gray; });
  bus.subscribe(msg::kEvents, [&impl](const core::EventPacket& packet) {
    impl.events.insert(impl.events.end(), packet.events.begin(), packet.events.end());
  });
}

Video::~Video() = default;

void Video::draw_chase(sim::World& world) {
  if (world.now() >= impl_->next_due) world.draw_chase(impl_->chase);
}

cv::Mat Video::Impl::compose(const PictureRecord& record) const {
  cv::Mat frame_pane = bgr(gray_pane(frame, sensor));
  cv::Mat event_view = bgr(event_pane(events, sensor));
  cv::Mat picture_pane = bgr(gray_pane(picture, sensor));
  cv::Mat chase_pane = bgr(chase);
  for (const core::TagDetection& tag : record.detections) outline(picture_pane, tag);
  write(frame_pane, "frame camera (APS)", {10, 24});
  write(event_view, "events since the last frame", {10, 24});
  write(picture_pane, "reconstructed picture and tag", {10, 24});
  write(chase_pane, "outside view (lit for the viewer)", {10, 24});

  cv::Mat top, bottom, all;
  cv::hconcat(frame_pane, event_view, top);
  cv::hconcat(picture_pane, chase_pane, bottom);
  cv::vconcat(top, bottom, all);
  cv::Mat strip(kCaptionHeight, all.cols, CV_8UC3, cv::Scalar(30, 30, 30));
  write(strip, caption(record), {10, 27});
  cv::vconcat(all, strip, all);
  return all;
}

void Video::add(const PictureRecord& record) {
  if (record.truth.t < impl_->next_due) return;
  const cv::Mat frame = impl_->compose(record);
  for (; impl_->next_due <= record.truth.t; impl_->next_due += kFrameInterval) {
    impl_->writer.write(frame);
    ++impl_->frames_written;
  }
  impl_->events.clear();
}

void Video::finish() {
  impl_->writer.release();
  // The writer itself says nothing of a full disk or a codec that gives up.
  const std::string path = impl_->folder.part(kVideoFile).string();
  const int readable = impl_->frames_written > 0 ? video_frames(path) : 0;
  if (readable == 0 || readable != impl_->frames_written)
    throw std::runtime_error(fmt::format("{}: {} frames can be read of {} written", path, readable,
                                         impl_->frames_written));
  impl_->folder.complete(kVideoFile);
}

}  // namespace nightjar::scenarios
