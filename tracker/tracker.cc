#include "tracker/tracker.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "tracker/tag_fix.h"
#include "tracker/tag_pose.h"

namespace nightjar::tracker {
namespace {

// Longer than any picture delay the config allows.
constexpr core::Time kHistory = std::chrono::milliseconds(500);
// The white border widens the black square by 10 cells to 8.
constexpr double kBorder = 1.25;

/// The detection with each side of the square moved outwards by `inset_px`.
core::TagDetection widened(core::TagDetection tag, double inset_px) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double perimeter_px = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    centre += 0.25 * tag.corner_px[i];
    perimeter_px += (tag.corner_px[(i + 1) % 4] - tag.corner_px[i]).norm();
  }
  const double scale = 1.0 + 8.0 * inset_px / perimeter_px;  // two insets a side of a quarter
  for (Eigen::Vector2d& corner : tag.corner_px) corner = centre + scale * (corner - centre);
  return tag;
}

core::Time milliseconds(double ms) { return core::from_seconds(ms * 1e-3); }

TrackerConfig checked(const TrackerConfig& config) {
  core::check_config(config, "tracker");
  return config;
}

}  // namespace

Tracker::Tracker(const TrackerConfig& config, const core::CameraModel& camera,
                 const Eigen::Isometry3d& T_body_camera)
    : config_(checked(config)),
      camera_(camera),
      T_body_camera_(T_body_camera),
      history_(kHistory, milliseconds(config.max_state_age_ms)),
      detector_(config.detector),
      ekf_(config.filter),
      mission_(config.mission),
      controller_(config.controller) {}

void Tracker::add_vehicle_state(const core::VehicleState& state) { history_.add(state); }

TrackerOutput Tracker::process(const core::Picture& picture) {
  if (picture.gray.size() != camera_.size)
    throw std::invalid_argument(fmt::format("picture of {} x {} px, allowed {} x {} px",
                                            picture.gray.width(), picture.gray.height(),
                                            camera_.size.width_px, camera_.size.height_px));
  const auto vehicle = history_.at(picture.t);
  if (!vehicle)
    throw std::invalid_argument(
        fmt::format("picture at {} us, no vehicle state of that time or up to {:g} ms before it",
                    picture.t.count(), config_.max_state_age_ms));

  TrackerOutput output;
  const core::Time seen_t = picture.t - milliseconds(config_.picture_delay_ms);
  if (const auto seen_from = history_.at(seen_t)) {  // nothing just after the start
    const Eigen::Isometry3d T_world_camera = seen_from->T_world_body() * T_body_camera_;
    const auto window = predicted_window(seen_t, T_world_camera);
    output.whole_picture = !window;
    output.detections = detector_.detect(picture, window);
    output.fix = fuse(output.detections, seen_t, T_world_camera);
  }

  output.estimate = estimate_at(picture.t);
  const FlightGoal goal = mission_.step(*vehicle, output.estimate);
  const double ahead_s = config_.command_delay_ms * 1e-3;
  output.setpoint = controller_.step(extrapolate(*vehicle, ahead_s), extrapolate(goal, ahead_s));
  output.phase = mission_.phase();
  output.transitions = mission_.take_transitions();
  return output;
}

/// Around the predicted tag with its border; nothing (the whole picture) while
/// there is no trust in the prediction, or if it lies off the sensor.
std::optional<Window> Tracker::predicted_window(core::Time t,
                                                const Eigen::Isometry3d& T_world_camera) const {
  const core::TargetEstimate tag = ekf_.estimate_at(t);
  if (!config_.window.enabled || !tag.valid || misses_ >= config_.window.full_frame_after_misses)
    return std::nullopt;
  const Eigen::Isometry3d T_camera_tag =
      T_world_camera.inverse() * Eigen::Translation3d(tag.p_world_tag_m) *
      Eigen::AngleAxisd(tag.heading_rad, Eigen::Vector3d::UnitZ());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : tag_corners_m(kBorder * config_.detector.tag_size_m)) {
    const auto pixel = camera_.project(T_camera_tag * corner);
    if (!pixel) return std::nullopt;
    box.extend(*pixel);
  }
  const double sigma_px =
      camera_.fx_px * tag.sigma_p_m.maxCoeff() / T_camera_tag.translation().norm();
  const double margin_px = config_.window.margin_px + config_.window.sigmas * sigma_px;
  const Eigen::Array2d rim(camera_.size.width_px, camera_.size.height_px);
  const Eigen::Array2d low = (box.min().array() - margin_px).floor().max(0.0).min(rim);
  const Eigen::Array2d high = (box.max().array() + margin_px + 1).ceil().max(0.0).min(rim);
  if ((low >= high).any()) return std::nullopt;
  const Eigen::Array2i first = low.cast<int>(), size = (high - low).cast<int>();
  return Window{first.x(), first.y(), size.x(), size.y()};
}

/// Offers the filter both poses of every detection of our tag.
FixResult Tracker::fuse(const std::vector<core::TagDetection>& detections, core::Time t,
                        const Eigen::Isometry3d& T_world_camera) {
  const double tag_size_m = config_.detector.tag_size_m;
  std::vector<TagFix> alternatives;
  for (const core::TagDetection& detection : detections) {
    if (detection.id != config_.detector.tag_id) continue;
    const core::TagDetection tag = widened(detection, config_.measurement.corner_inset_px);
    for (const TagPoseSolution& pose : tag_poses(tag, camera_, tag_size_m))
      if (const auto fix =
              tag_fix(t, pose, T_world_camera, camera_, tag_size_m, config_.measurement))
        alternatives.push_back(*fix);
  }
  const FixResult result = ekf_.update(alternatives);
  misses_ = result == FixResult::none || result == FixResult::gated ? misses_ + 1 : 0;
  return result;
}

/// The filter counts in the time of what was seen, everyone else in pictures.
core::TargetEstimate Tracker::estimate_at(core::Time picture_t) const {
  core::TargetEstimate estimate = ekf_.estimate_at(picture_t);
  if (estimate.valid) estimate.last_tag += milliseconds(config_.picture_delay_ms);
  return estimate;
}

}  // namespace nightjar::tracker
