#include "scenarios/video.h"

#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "tests/support/picture_records.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

/// Frames of a video of pictures every `interval`, up to `end`.
int frames(core::Time interval, core::Time end) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  msg::Bus bus;
  Video video(bus, folder, test::davis_camera());
  for (core::Time t = interval; t <= end; t += interval) video.add(test::perfect_record(t));
  video.finish();
  cv::VideoCapture written(folder.path(kVideoFile).string());
  int count = 0;
  for (cv::Mat frame; written.read(frame); ++count) EXPECT_FALSE(frame.empty());
  return count;
}

TEST(Video, RunsInRealTimeWhateverThePictureInterval) {
  EXPECT_EQ(frames(10ms, 840ms), 21);
  EXPECT_EQ(frames(7ms, 840ms), 21);   // no divisor of 40 ms
  EXPECT_EQ(frames(70ms, 840ms), 21);  // longer: frames are repeated
}

TEST(Video, WithoutAnyFrameIsAnError) { EXPECT_THROW(frames(10ms, 30ms), std::runtime_error); }

}  // namespace
}  // namespace nightjar::scenarios
