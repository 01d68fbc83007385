#include "scenarios/tag_score.h"

namespace nightjar::scenarios {
namespace {

constexpr double kMaxCornerError_px = 5.0;

bool corners_agree(const core::TagDetection& tag, const std::array<Eigen::Vector2d, 4>& truth_px) {
  for (std::size_t i = 0; i < truth_px.size(); ++i)
    if (!((tag.corner_px[i] - truth_px[i]).norm() <= kMaxCornerError_px)) return false;
  return true;
}

}  // namespace

std::optional<std::array<Eigen::Vector2d, 4>> project_tag(const core::CameraModel& camera,
                                                          const core::Truth& truth,
                                                          double tag_size_m) {
  const double h_m = 0.5 * tag_size_m;
  const std::array<Eigen::Vector3d, 4> corners_tag_m{
      {{-h_m, h_m, 0}, {-h_m, -h_m, 0}, {h_m, -h_m, 0}, {h_m, h_m, 0}}};
  const Eigen::Isometry3d T_camera_tag = truth.T_world_camera.inverse() * truth.T_world_tag;
  std::array<Eigen::Vector2d, 4> corners_px;
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const auto pixel = camera.project(T_camera_tag * corners_tag_m[i]);
    if (!pixel) return std::nullopt;
    corners_px[i] = *pixel;
  }
  return corners_px;
}

TagScore score_tags(const core::CameraModel& camera, const core::Truth& truth,
                    const TagConfig& printed, std::span<const core::TagDetection> detections) {
  const auto truth_px = project_tag(camera, truth, printed.size_m);
  TagScore score;
  for (const core::TagDetection& tag : detections) {
    const bool right = tag.id == printed.id && truth_px && corners_agree(tag, *truth_px);
    if (right && !score.detected)
      score.detected = true;
    else
      ++score.false_detections;
  }
  return score;
}

}  // namespace nightjar::scenarios
