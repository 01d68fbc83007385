#include "camera/video_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using testing::EndsWith;
using testing::ThrowsMessage;

constexpr int kFrames = 10;

/// Ten flat gray frames at 25 Hz, each 20 codes brighter than the one before.
void write_video(const std::filesystem::path& path) {
  cv::VideoWriter video(path.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {32, 24});
  ASSERT_TRUE(video.isOpened());
  for (int i = 0; i < kFrames; ++i)
    video.write(cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(20 + 20 * i)));
}

TEST(VideoFileTest, reads_every_frame_of_a_video_in_order) {
  const test::ScratchFolder folder;
  write_video(folder / "gray.avi");
  const auto frames = open_frames(folder / "gray.avi", {});
  EXPECT_DOUBLE_EQ(frames->rate_hz(), 25);
  EXPECT_EQ(frames->announced_frames(), kFrames);
  core::Image<float> frame;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(frames->next(frame));
    EXPECT_EQ(frame.size(), (core::Resolution{32, 24}));
    // JPEG and the way to YUV and back: a few codes.
    EXPECT_NEAR(255 * frame(16, 12), 20 + 20 * i, 4);
  }
  EXPECT_FALSE(frames->next(frame));
  EXPECT_EQ(frames->bad_values(), 0u);
}

TEST(VideoFileTest, takes_the_rate_at_which_it_was_taken_and_the_size_from_the_options) {
  const test::ScratchFolder folder;
  write_video(folder / "gray.avi");
  const auto frames =
      open_frames(folder / "gray.avi", {.rate_hz = 960.0, .size = core::Resolution{16, 8}});
  EXPECT_EQ(frames->rate_hz(), 960);
  core::Image<float> frame;
  ASSERT_TRUE(frames->next(frame));
  EXPECT_EQ(frame.size(), (core::Resolution{16, 8}));
}

TEST(VideoFileTest, names_a_file_that_is_no_video) {
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // see open_frames()
  const test::ScratchFolder folder;
  std::ofstream(folder / "gray.mp4") << "this is no video";
  EXPECT_THAT(
      [&] { open_frames(folder / "gray.mp4", {}); },
      ThrowsMessage<std::invalid_argument>(EndsWith("gray.mp4: cannot be read as a video")));
}

}  // namespace
}  // namespace nightjar::camera
