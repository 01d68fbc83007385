#include "scenarios/moved_name.h"

#include <gtest/gtest.h>

namespace nightjar::scenarios {
namespace {

TEST(MovedNameTest, is_the_same_file_from_another_folder) {
  EXPECT_EQ(moved_name("camera.yaml", "/nowhere/a", "/nowhere/b/c"), "../../a/camera.yaml");
  EXPECT_EQ(moved_name("/nowhere/camera.yaml", "/nowhere/a", "/nowhere/b"), "../camera.yaml");
  EXPECT_EQ(moved_name("", "/nowhere/a", "/nowhere/b"), "");
}

TEST(MovedNameTest, a_name_that_no_file_can_have_is_left_to_who_opens_it) {
  const std::string name(300, 'n');  // file systems allow 255
  EXPECT_EQ(moved_name(name, "/tmp", "/"), "/tmp/" + name);
}

}  // namespace
}  // namespace nightjar::scenarios
