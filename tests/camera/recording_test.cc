#include "camera/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/data_folder.h"
#include "tests/support/recordings.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(OpenRecordingTest, reads_the_real_davis346_recording_to_the_last_event) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const test::WholeRecording road = test::read_all(*folder / "davis346_road.aedat4");
  // The counts are those of the page that came with the file.
  EXPECT_EQ(road.format, "AEDAT4");
  EXPECT_EQ(road.camera, "DAVIS346_00000002");
  EXPECT_EQ(road.size, (core::Resolution{346, 260}));
  ASSERT_EQ(road.all.events.size(), 6676u);
  EXPECT_EQ(std::ranges::count_if(road.all.events, &Event::on), 3563);
  EXPECT_EQ(road.all.events.front().t, Time(1589163147368868));
  EXPECT_EQ(road.all.events.back().t - road.all.events.front().t, Time(169941));
  EXPECT_EQ(road.all.frames.size(), 4u);
  EXPECT_EQ(road.all.imu.size(), 160u);
  EXPECT_EQ(road.all.triggers.size(), 17u);
  EXPECT_FALSE(road.faults.any()) << road.faults.first;
}

TEST(OpenRecordingTest, reads_frames_and_inertia_of_the_real_recording_in_camera_axes) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const test::WholeRecording road = test::read_all(*folder / "davis346_road.aedat4");
  for (const RecordedFrame& frame : road.all.frames) {
    EXPECT_EQ(frame.gray.size(), road.size);
    EXPECT_EQ(frame.bits, 8);
    EXPECT_LE(frame.frame_begin, frame.exposure_begin);
    EXPECT_LE(frame.exposure_end, frame.frame_end);
  }
  for (const RecordedImu& sample : road.all.imu) {
    // At rest: gravity within the chip's 60 mg of offset an axis, up being camera -y.
    EXPECT_NEAR(sample.specific_force_camera_m_s2.norm(), 9.81, 1.0);
    EXPECT_LT(sample.specific_force_camera_m_s2.y(), -9.0);
    // The view is 15 degrees below the horizon: see docs/recordings.md.
    EXPECT_NEAR(sample.specific_force_camera_m_s2.z(), -2.5, 0.5);
    EXPECT_NEAR(sample.temperature_c, 28.5, 0.5);       // as the file's first sample
    EXPECT_LT(sample.omega_camera_rad_s.norm(), 0.05);  // nothing moves
  }
}

}  // namespace
}  // namespace nightjar::camera
