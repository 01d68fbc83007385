#include "scenarios/corner_inset.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>

#include "esi/make_network.h"
#include "scenarios/tag_score.h"
#include "sim/carried_camera.h"
#include "tests/support/sim_scene.h"
#include "tracker/config.h"
#include "tracker/tag_detector.h"

namespace nightjar::scenarios {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;

/// By how much the sides of a square lie inwards of where they are: the corners' mean way to
/// the middle. Nothing where a corner is so far off that it is another square.
std::optional<double> inset_px(const Corners& corner_px, const Corners& truth_px) {
  constexpr double kAnother_px = 5;
  const Eigen::Vector2d middle_px = (truth_px[0] + truth_px[1] + truth_px[2] + truth_px[3]) / 4;
  double inwards_px2 = 0, radius_px2 = 0, side_px = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d radius_px = truth_px[i] - middle_px;
    const Eigen::Vector2d error_px = corner_px[i] - truth_px[i];
    if (error_px.norm() > kAnother_px) return std::nullopt;
    inwards_px2 -= error_px.dot(radius_px);
    radius_px2 += radius_px.squaredNorm();
    side_px += (truth_px[(i + 1) % 4] - truth_px[i]).norm() / 4;
  }
  return inwards_px2 / radius_px2 * side_px / 2;
}

/// Mean over the pictures of the second second, the camera drifting over the tag in 5 lux.
double measured_inset_px(esi::Method method) {
  sim::CarriedCamera camera({}, {}, {}, test::arena(), 5, sim::CarryMotion::slow, 101);
  esi::ReconstructorConfig config;
  config.method = method;
  const auto reconstructor = esi::make_any_reconstructor(config, camera.model().size);
  tracker::TagDetector detector{tracker::DetectorConfig{}};
  const TagConfig printed;
  double sum_px = 0;
  int pictures = 0;
  for (core::Time t{}; t < core::from_seconds(2);) {
    const sim::CarriedStep step = camera.next();
    t = step.packet.end;
    reconstructor->process(step.packet.events);
    for (const core::ApsFrame& frame : step.frames) reconstructor->add_frame(frame);
    if (t < core::from_seconds(1)) continue;
    core::Picture picture;
    reconstructor->render(t, picture);
    const auto truth_px = project_tag(camera.model(), step.truth, printed.size_m).value();
    for (const core::TagDetection& tag : detector.detect(picture))
      if (const auto inset = inset_px(tag.corner_px, truth_px); inset && tag.id == printed.id) {
        sum_px += *inset;
        ++pictures;
      }
  }
  EXPECT_GE(pictures, 90);  // of 101: a slow camera, ESI's share in 5 lux is 99 %
  return sum_px / pictures;
}

// A slow camera in 5 lux shows 0.36 and 0.01 px. Over motions and lights that varies by 0.32 px
// with esi and by 0.18 with esi_net (docs/decisions/0009): a value that far from this one motion's
// as half the greater of the two suits none of them. Esi's and esi_net's lie 0.4 px apart.
constexpr double kTolerance_px = 0.16;

TEST(CornerInset, is_what_esi_shows) {
  EXPECT_NEAR(corner_inset_px(esi::Method::esi), measured_inset_px(esi::Method::esi),
              kTolerance_px);
}

TEST(CornerInset, is_what_esi_net_shows) {
  EXPECT_NEAR(corner_inset_px(esi::Method::esi_net), measured_inset_px(esi::Method::esi_net),
              kTolerance_px);
}

TEST(CornerInset, of_other_methods_is_the_trackers) {
  for (const auto& [name, method] : esi::kMethods) {
    if (method == esi::Method::esi_net) continue;
    EXPECT_EQ(corner_inset_px(method), tracker::MeasurementConfig{}.corner_inset_px) << name;
  }
}

}  // namespace
}  // namespace nightjar::scenarios
