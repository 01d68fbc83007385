#include "core/part_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/support/scratch_folder.h"

namespace nightjar::core {
namespace {

using test::file_text;
using testing::EndsWith;
using testing::ThrowsMessage;

TEST(PartFileTest, gives_a_file_its_name_when_it_is_complete) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "a.png") << "old";
  PartFile file(folder / "a.png");
  file.stream() << "new";
  EXPECT_EQ(file_text(folder / "a.png"), "old");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.part.png"));
  file.finish();
  EXPECT_EQ(file_text(folder / "a.png"), "new");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.part.png"));
}

TEST(PartFileTest, removes_what_was_not_finished) {
  const test::ScratchFolder folder;
  { PartFile(folder / "a.png").stream() << "half"; }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PartFileTest, leaves_other_files_of_the_parts_name_alone) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "a.part.png") << "mine";
  {
    PartFile first(folder / "a.png"), second(folder / "a.png");
    EXPECT_TRUE(std::filesystem::exists(folder / "a.part2.png"));
    EXPECT_TRUE(std::filesystem::exists(folder / "a.part3.png"));
    first.stream() << "first";
    first.finish();
    // Whoever takes the name that is free again keeps it.
    std::ofstream(folder / "a.part2.png") << "theirs";
  }
  EXPECT_EQ(file_text(folder / "a.png"), "first");
  EXPECT_EQ(file_text(folder / "a.part.png"), "mine");
  EXPECT_EQ(file_text(folder / "a.part2.png"), "theirs");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.part3.png"));
}

TEST(PartFileTest, names_a_place_where_nothing_can_be_written) {
  const test::ScratchFolder folder;
  EXPECT_THAT([&] { PartFile(folder / "none/a.png"); },
              ThrowsMessage<std::invalid_argument>(
                  EndsWith("none/a.png: cannot be written, No such file or directory")));
  EXPECT_THAT([&] { PartFile(folder.path()); },
              ThrowsMessage<std::invalid_argument>(EndsWith("is not a plain file")));
}

TEST(PartFileTest, tells_when_it_cannot_get_its_name) {
  const test::ScratchFolder folder;
  PartFile file(folder / "a.png");
  std::filesystem::create_directory(folder / "a.png");
  EXPECT_THROW(file.finish(), std::runtime_error);
}

}  // namespace
}  // namespace nightjar::core
