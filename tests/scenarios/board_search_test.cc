#include "scenarios/board_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenarios/calibration.h"
#include "scenarios/calibration_views.h"
#include "scenarios/gray_picture.h"
#include "sim/emulator.h"
#include "tests/support/board_pictures.h"
#include "tests/support/fake_recording.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;

const Checkerboard kBoard{7, 5, 0.03};
const auto kNoProgress = [](double) {};

/// A DAVIS240 behind the lens of distorting_camera().
core::CameraModel small_camera() {
  core::CameraModel camera = test::distorting_camera();
  constexpr double kScale = 240.0 / 346;
  camera.size = {240, 180};
  for (double* number : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    *number *= kScale;
  return camera;
}

/// Grey, so that an edge makes some nine events rather than fifteen.
test::BoardPaint gray_board() {
  return [paint = test::checkerboard_paint(kBoard)](double x_m, double y_m) {
    return 0.1 + 0.75 * paint(x_m, y_m);
  };
}

/// A board swung through the picture, nearer and farther and tilted both ways; `turns` of it.
Eigen::Isometry3d swung(double turns) {
  const double a = 2 * std::numbers::pi * turns;
  const double away_m = 0.396 - 0.06 * std::cos(2 * a + 0.5);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(0.5 * std::sin(3 * a), Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(0.5 * std::cos(4 * a), Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  T.translation() = Eigen::Vector3d((0.55 * away_m - 0.132) * std::sin(2 * a),
                                    (0.42 * away_m - 0.1) * std::sin(5 * a), away_m) -
                    T.linear() * Eigen::Vector3d(0.09, 0.06, 0);
  return T;
}

/// Events of the swung board: 400 pictures 10 ms apart, clean pixels, seed 1.
test::FakeRecording events_of_the_board() {
  const test::BoardCamera camera(small_camera(), 2);
  sim::SensorConfig sensor;
  sensor.preset = sim::SensorPreset::clean;
  sim::EventEmulator pixels(sim::effective_pixel(sensor, 100), camera.model().size, 1.0, 1);
  std::vector<camera::RecordingPart> parts;
  core::Image<float> luminance(camera.model().size);
  for (int i = 0; i < 400; ++i) {
    const core::Picture picture = camera.draw(gray_board(), swung(i / 800.0));
    std::ranges::transform(picture.gray.pixels(), luminance.pixels().begin(),
                           [](std::uint8_t gray) { return static_cast<float>(gray) / 255.0f; });
    parts.emplace_back();
    pixels.step(std::chrono::milliseconds(10 * i), luminance, parts.back().events);
  }
  return {camera.model().size, std::move(parts)};
}

TEST(BoardSearchTest, a_board_moved_before_an_event_camera_calibrates_it) {
  test::FakeRecording recording = events_of_the_board();
  ReconstructOptions options;  // by ESI
  options.rate_hz = 10;
  double done = 0;
  const BoardSearch found = search_events(recording, options, *make_checkerboard_finder(kBoard),
                                          [&](double share) { done = share; });
  EXPECT_EQ(found.pictures, 39u);
  EXPECT_GE(found.views.size(), 30u);
  EXPECT_EQ(found.views.at(0).picture.substr(4), "0 s");
  EXPECT_GT(done, 0.9);

  const core::CameraModel truth = small_camera();
  const Calibration result = calibrate(choose_views(found.views, found.size, 40), found.size, {});
  // Four standard deviations, which the calibration gives itself. A hundred pictures of this
  // board from 15 events an edge gave an rms of 0.3 px.
  EXPECT_LT(result.rms_px, 0.6);
  EXPECT_NEAR(result.camera.fx_px, truth.fx_px, 4 * result.sigma.fx_px);
  EXPECT_NEAR(result.camera.fy_px, truth.fy_px, 4 * result.sigma.fy_px);
  EXPECT_NEAR(result.camera.cx_px, truth.cx_px, 4 * result.sigma.cx_px);
  EXPECT_NEAR(result.camera.cy_px, truth.cy_px, 4 * result.sigma.cy_px);
  EXPECT_NEAR(result.camera.lens.k1, truth.lens.k1, 4 * result.sigma.lens.k1);
  EXPECT_LT(result.sigma.fx_px, 0.02 * truth.fx_px);  // and they are of use
}

/// Takes every picture for one of the board.
class WillingFinder : public BoardFinder {
 public:
  std::optional<BoardView> find(const core::Picture&) override { return BoardView{}; }
};

test::FakeRecording with_a_pause() {
  using namespace std::chrono_literals;
  std::vector<camera::RecordingPart> parts(1);
  for (const auto t : {0ms, 250ms, 90000ms, 90250ms}) parts[0].events.push_back({1s + t, 1, 1, 1});
  return {{8, 8}, std::move(parts)};
}

TEST(BoardSearchTest, views_behind_a_long_pause_have_their_own_times) {
  test::FakeRecording recording = with_a_pause();
  WillingFinder finder;
  ReconstructOptions options;
  options.rate_hz = 10;
  const BoardSearch found = search_events(recording, options, finder, kNoProgress);
  std::vector<std::string> pictures;
  for (const BoardView& view : found.views) pictures.push_back(view.picture);
  EXPECT_THAT(pictures,
              testing::ElementsAre("0.100 s", "0.200 s", "90.000 s", "90.100 s", "90.200 s"));
}

/// Frames of a board held still at each place, the last a region of interest.
test::FakeRecording frames_of_the_board() {
  const test::BoardCamera camera(small_camera());
  std::vector<camera::RecordingPart> parts(1);
  for (int i = 0; i < 3; ++i) {
    const core::Picture picture = camera.draw(gray_board(), swung(0.05 + 0.15 * i));
    camera::RecordedFrame frame;
    frame.exposure_begin = std::chrono::milliseconds(5000 + 250 * i);
    frame.exposure_end = frame.exposure_begin + std::chrono::milliseconds(4);
    frame.bits = 10;
    if (i == 2) frame.left_px = 8, frame.top_px = 4;
    frame.gray = core::Image<std::uint16_t>({240 - frame.left_px, 180 - frame.top_px});
    for (int y = 0; y < frame.gray.height(); ++y)
      for (int x = 0; x < frame.gray.width(); ++x)
        frame.gray(x, y) =
            static_cast<std::uint16_t>(4 * picture.gray(x + frame.left_px, y + frame.top_px));
    parts[0].frames.push_back(frame);
  }
  return {camera.model().size, std::move(parts)};
}

TEST(BoardSearchTest, finds_the_board_in_frames_where_they_are_on_the_sensor) {
  test::FakeRecording recording = frames_of_the_board();
  const BoardSearch found =
      search_frames(recording, *make_checkerboard_finder(kBoard), kNoProgress);
  EXPECT_EQ(found.pictures, 3u);
  EXPECT_EQ(found.size, (core::Resolution{240, 180}));
  ASSERT_EQ(found.views.size(), 3u);
  EXPECT_EQ(found.views[2].picture, "0.500 s");
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : found.views[2].corner_px) middle += corner / 35;
  Eigen::Vector2d truth = Eigen::Vector2d::Zero();
  for (int i = 0; i < 35; ++i)
    truth +=
        *small_camera().project(swung(0.35) * Eigen::Vector3d(0.03 * (i % 7), 0.03 * (i / 7), 0)) /
        35;
  EXPECT_LT((middle - truth).norm(), 0.1);  // OpenCV's finder: a tenth each, the mean better
}

TEST(BoardSearchTest, a_recording_without_frames_is_refused) {
  test::FakeRecording recording({240, 180}, std::vector<camera::RecordingPart>(1));
  try {
    search_frames(recording, *make_checkerboard_finder(kBoard), kNoProgress);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("the recording has no frames"));
  }
}

TEST(BoardSearchTest, looks_into_every_picture_of_a_folder) {
  const test::ScratchFolder folder;
  const test::BoardCamera camera(small_camera());
  write_png(folder / "1.png", camera.draw(gray_board(), swung(0.05)).gray);
  write_png(folder / "2.png", core::Image<std::uint8_t>({240, 180}, 90));
  write_png(folder / "10.png", camera.draw(gray_board(), swung(0.2)).gray);
  std::vector<double> shares;
  const BoardSearch found = search_pictures(folder.path(), *make_checkerboard_finder(kBoard),
                                            [&](double share) { shares.push_back(share); });
  EXPECT_EQ(found.pictures, 3u);
  ASSERT_EQ(found.views.size(), 2u);
  EXPECT_EQ(found.views[1].picture, "picture 3");
  EXPECT_THAT(shares, testing::ElementsAre(1.0 / 3, 2.0 / 3, 1.0));
}

}  // namespace
}  // namespace nightjar::scenarios
