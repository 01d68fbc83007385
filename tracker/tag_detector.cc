#include "tracker/tag_detector.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>

namespace nightjar::tracker {
namespace {

// AprilTag thresholds by tiles of this size: a window on the same grid gives
// the same black and white as the whole picture.
constexpr int kTile_px = 4;
// A tag that decodes has 8 cells of about 2 px; less than that is no picture.
constexpr int kLeastWindow_px = 16;
// A tag whose white border the rim cuts off still decodes, its lost edge put
// inside the outermost tiles, 10 px wrong and more.
constexpr double kRim_px = 2 * kTile_px;
// AprilTag puts the middle of the top left pixel at (0.5, 0.5), core at (0, 0).
constexpr double kPixelCentre_px = 0.5;

struct DeleteFamily {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct DeleteDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct DeleteDetections {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};

/// The window grown to whole tiles and clipped to the picture.
cv::Rect on_tiles(const Window& window, core::Resolution size) {
  const auto down = [](int v) { return std::max(0, v) / kTile_px * kTile_px; };
  const auto up = [](int v, int end) {
    return std::min((std::max(0, v) + kTile_px - 1) / kTile_px * kTile_px, end);
  };
  const int x = std::min(down(window.x_px), size.width_px);
  const int y = std::min(down(window.y_px), size.height_px);
  return {x, y, std::max(0, up(window.x_px + window.width_px, size.width_px) - x),
          std::max(0, up(window.y_px + window.height_px, size.height_px) - y)};
}

bool is_whole(const apriltag_detection_t& found, const cv::Rect& part) {
  return std::all_of(std::begin(found.p), std::end(found.p), [&](const double(&corner)[2]) {
    return corner[0] >= kRim_px && corner[0] <= part.width - kRim_px && corner[1] >= kRim_px &&
           corner[1] <= part.height - kRim_px;
  });
}

core::TagDetection converted(const apriltag_detection_t& found, core::Time t, cv::Point origin) {
  core::TagDetection detection{.t = t,
                               .id = found.id,
                               .hamming = found.hamming,
                               .decision_margin = found.decision_margin,
                               .corner_px = {}};
  for (std::size_t i = 0; i < 4; ++i)
    detection.corner_px[i] = {found.p[i][0] - kPixelCentre_px + origin.x,
                              found.p[i][1] - kPixelCentre_px + origin.y};
  return detection;
}

}  // namespace

struct TagDetector::Impl {
  explicit Impl(const DetectorConfig& detector_config);

  /// A smoothed copy of a part of the picture. AprilTag gets a copy in any
  /// case: it takes a pointer that it may write to.
  void smooth(const cv::Mat& part);

  DetectorConfig config;
  std::unique_ptr<apriltag_family_t, DeleteFamily> family;
  std::unique_ptr<apriltag_detector_t, DeleteDetector> detector;
  cv::Mat median, smoothed;
};

TagDetector::Impl::Impl(const DetectorConfig& detector_config) : config(detector_config) {
  core::check_config(config, "detector");
  family.reset(tag36h11_create());
  detector.reset(apriltag_detector_create());
  apriltag_detector_add_family_bits(detector.get(), family.get(), config.max_hamming);
  detector->nthreads = 1;
  detector->quad_decimate = static_cast<float>(config.quad_decimate);
  detector->quad_sigma = 0;
  detector->refine_edges = config.refine_edges;
  detector->decode_sharpening = config.decode_sharpening;
  detector->qtp.min_white_black_diff = config.min_white_black_diff;
  detector->qtp.max_line_fit_mse = static_cast<float>(config.max_line_fit_mse_px2);
}

void TagDetector::Impl::smooth(const cv::Mat& part) {
  if (config.median == Median::off)
    part.copyTo(median);
  else
    cv::medianBlur(part, median, config.median == Median::px3 ? 3 : 5);
  if (config.blur_sigma_px > 0)
    cv::GaussianBlur(median, smoothed, {0, 0}, config.blur_sigma_px);
  else
    median.copyTo(smoothed);
}

TagDetector::TagDetector(const DetectorConfig& config) : impl_(std::make_unique<Impl>(config)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<core::TagDetection> TagDetector::detect(const core::Picture& picture,
                                                    std::optional<Window> window) {
  const core::Resolution size = picture.gray.size();
  const cv::Rect part =
      on_tiles(window.value_or(Window{0, 0, size.width_px, size.height_px}), size);
  if (part.width < kLeastWindow_px || part.height < kLeastWindow_px) return {};

  const cv::Mat whole(size.height_px, size.width_px, CV_8U,
                      const_cast<std::uint8_t*>(picture.gray.pixels().data()));
  impl_->smooth(whole(part));
  image_u8_t image{.width = part.width,
                   .height = part.height,
                   .stride = static_cast<int>(impl_->smoothed.step),
                   .buf = impl_->smoothed.data};
  const std::unique_ptr<zarray_t, DeleteDetections> found(
      apriltag_detector_detect(impl_->detector.get(), &image));

  std::vector<core::TagDetection> detections;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* tag = nullptr;
    zarray_get(found.get(), i, &tag);
    if (tag->decision_margin >= impl_->config.min_decision_margin && is_whole(*tag, part))
      detections.push_back(converted(*tag, picture.t, part.tl()));
  }
  return detections;
}

}  // namespace nightjar::tracker
