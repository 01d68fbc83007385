#include "core/image.h"

#include <gtest/gtest.h>

namespace nightjar::core {
namespace {

TEST(Image, IsRowMajorFromTheTop) {
  Image<int> image({3, 2});
  image(2, 0) = 5;
  image(0, 1) = 7;
  EXPECT_EQ(image.pixels()[2], 5);
  EXPECT_EQ(image.pixels()[3], 7);
}

TEST(Image, EqualityLooksAtSizeAndPixels) {
  EXPECT_EQ(Image<int>({3, 2}, 1), Image<int>({3, 2}, 1));
  EXPECT_NE(Image<int>({3, 2}, 1), Image<int>({2, 3}, 1));
  EXPECT_NE(Image<int>({3, 2}, 1), Image<int>({3, 2}, 2));
}

TEST(Time, SecondsRoundToTheNearestMicrosecond) {
  EXPECT_EQ(from_seconds(1.2345674), Time(1234567));
  EXPECT_EQ(from_seconds(-1.2345678), Time(-1234568));
  EXPECT_DOUBLE_EQ(seconds(Time(1500000)), 1.5);
}

}  // namespace
}  // namespace nightjar::core
