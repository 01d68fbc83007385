#include "camera/natural_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace nightjar::camera {
namespace {

using testing::ElementsAreArray;

TEST(NaturalOrderTest, puts_names_as_people_number_them) {
  const std::vector<std::string> ordered = {"",
                                            "9",
                                            "10",
                                            "a",
                                            "a1b9",
                                            "a1b10",
                                            "a2",
                                            "frame.png",
                                            "frame2.png",
                                            "frame10.png",
                                            "frame010.png.bak"};
  std::vector<std::string> names = ordered;
  std::reverse(names.begin(), names.end());
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_THAT(names, ElementsAreArray(ordered));
}

TEST(NaturalOrderTest, tells_apart_names_of_the_same_number) {
  EXPECT_TRUE(natural_less("frame02", "frame2"));
  EXPECT_FALSE(natural_less("frame2", "frame02"));
  EXPECT_FALSE(natural_less("frame2", "frame2"));
}

TEST(NaturalOrderTest, compares_numbers_too_long_for_any_integer) {
  EXPECT_TRUE(natural_less("99999999999999999999998", "99999999999999999999999"));
  EXPECT_TRUE(natural_less("99999999999999999999999", "100000000000000000000000"));
}

}  // namespace
}  // namespace nightjar::camera
