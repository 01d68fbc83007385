#include "scenarios/reconstruction_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "scenarios/gray_picture.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr core::Resolution kSize{17, 13};  // odd: a codec takes even sides only

core::Picture picture(core::Time t) {
  core::Picture picture{.t = t, .gray = core::Image<std::uint8_t>(kSize)};
  for (int x = 0; x < kSize.width_px; ++x) picture.gray(x, 2) = static_cast<std::uint8_t>(10 * x);
  return picture;
}

core::TagDetection tag() {
  return {.t = 1589163147368868us,
          .id = 7,
          .hamming = 1,
          .decision_margin = 40.25,
          .corner_px = {{{1, 2}, {3.5, 4}, {5, 6}, {7, 8.1239}}}};
}

class ReconstructionFolderTest : public testing::Test {
 protected:
  ReconstructionFolder::Options options(bool video) const {
    return {.video = video, .tags = true, .size = kSize, .rate_hz = 100};
  }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
      names.insert(entry.path().filename().string());
    return names;
  }

  test::ScratchFolder folder_;
};

TEST_F(ReconstructionFolderTest, holds_pictures_times_tags_and_a_summary) {
  ReconstructionFolder folder(folder_ / "out", options(false));
  folder.add(picture(1589163147368868us), std::vector{tag()});
  folder.add(picture(1589163147378868us), {});
  folder.finish("{}\n");
  EXPECT_THAT(names(), UnorderedElementsAre("picture_000001.png", "picture_000002.png", "times.csv",
                                            "tags.csv", "summary.json"));
  EXPECT_EQ(test::file_text(folder_ / "out/times.csv"),
            "picture,time_us\n1,1589163147368868\n2,1589163147378868\n");
  EXPECT_EQ(test::file_text(folder_ / "out/tags.csv"),
            "time_us,id,hamming,decision_margin,corners_px\n"
            "1589163147368868,7,1,40.250,1.000 2.000 3.500 4.000 5.000 6.000 7.000 8.124\n");
  EXPECT_EQ(read_gray_picture(folder_ / "out/picture_000002.png"), picture(0us).gray);
}

TEST_F(ReconstructionFolderTest, holds_a_video_instead_of_pictures) {
  ReconstructionFolder folder(folder_ / "out", options(true));
  for (int i = 0; i < 5; ++i) folder.add(picture(i * 1ms), {});
  folder.finish("{}\n");
  EXPECT_THAT(names(),
              UnorderedElementsAre("pictures.mp4", "times.csv", "tags.csv", "summary.json"));
  EXPECT_EQ(video_frames(folder_ / "out/pictures.mp4"), 5);
}

TEST_F(ReconstructionFolderTest, leaves_nothing_of_what_was_not_finished) {
  for (const bool video : {false, true}) {
    {
      ReconstructionFolder folder(folder_ / "out", options(video));
      folder.add(picture(0ms), {});
      EXPECT_FALSE(names().empty());
      EXPECT_FALSE(names().contains("summary.json"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  }
}

TEST_F(ReconstructionFolderTest, replaces_an_earlier_result_and_nothing_else) {
  std::filesystem::create_directory(folder_ / "out");
  for (const char* name : {"picture_000009.png", "pictures.mp4", "tags.csv", "summary.json",
                           "picture_9.png", "mine.txt"})
    std::ofstream(folder_ / "out" / name) << "old";
  { const ReconstructionFolder folder(folder_ / "out", options(false)); }
  EXPECT_THAT(names(), UnorderedElementsAre("picture_9.png", "mine.txt"));
  ReconstructionFolder folder(folder_ / "out", options(true));
  folder.finish("{}\n");  // no picture: no video
  EXPECT_THAT(names(), UnorderedElementsAre("picture_9.png", "mine.txt", "times.csv", "tags.csv",
                                            "summary.json"));
}

TEST_F(ReconstructionFolderTest, refuses_a_path_that_is_a_file) {
  std::ofstream(folder_ / "out") << "mine";
  EXPECT_THROW(ReconstructionFolder(folder_ / "out", options(false)), std::invalid_argument);
  EXPECT_EQ(test::file_text(folder_ / "out"), "mine");
}

TEST(GrayPictureTest, refuses_what_is_no_picture) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "a.png") << "text";
  for (const char* name : {"a.png", "none.png"}) {
    try {
      read_gray_picture(folder / name);
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(name) + ": cannot be read as a picture"));
    }
  }
}

}  // namespace
}  // namespace nightjar::scenarios
