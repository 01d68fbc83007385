#include "camera/caer_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::camera {
namespace {

// With libcaer, no camera has this number; without, the error says where to get it.
TEST(CaerDeviceTest, says_what_to_do_when_there_is_no_such_camera) {
  try {
    open_caer_device("no such");
    FAIL() << "opened a camera";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("source."));
    EXPECT_THAT(error.what(), testing::HasSubstr("docs/hardware.md"));
  }
}

}  // namespace
}  // namespace nightjar::camera
