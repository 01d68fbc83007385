#include "camera/picture_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;
using testing::ThrowsMessage;

constexpr float kRounding = 1e-6f;  // a few roundings of a float near 1

/// 4x2 pixels whose codes span 0 to 255.
cv::Mat codes() { return (cv::Mat_<uchar>(2, 4) << 0, 1, 20, 64, 100, 128, 200, 255); }

cv::Mat scaled(const cv::Mat& picture, int type, double factor) {
  cv::Mat out;
  picture.convertTo(out, type, factor);
  return out;
}

class PictureFolderTest : public testing::Test {
 protected:
  void write(const std::string& name, const cv::Mat& picture) const {
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);  // see open_frames()
    ASSERT_TRUE(cv::imwrite((folder_ / name).string(), picture)) << name;
  }
  void write_two(const std::string& extension, const cv::Mat& picture) const {
    write("frame1" + extension, picture);
    write("frame2" + extension, picture);
  }

  std::unique_ptr<FrameSource> open() const { return open_frames(folder_.path(), options); }

  std::vector<float> first_frame() const {
    core::Image<float> frame;
    EXPECT_TRUE(open()->next(frame));
    return {frame.pixels().begin(), frame.pixels().end()};
  }

  /// What reading every frame throws.
  auto reading() const {
    return [this] {
      const auto frames = open();
      core::Image<float> frame;
      while (frames->next(frame)) continue;
    };
  }

  test::ScratchFolder folder_;
  FrameOptions options{.rate_hz = 100.0};
};

/// The same picture in one of the formats people have.
struct Format {
  const char* extension;
  int type;
  double white;
};

class PictureFormatTest : public PictureFolderTest, public testing::WithParamInterface<Format> {};

INSTANTIATE_TEST_SUITE_P(AllFormats, PictureFormatTest,
                         testing::Values(Format{".png", CV_8U, 255}, Format{".pgm", CV_8U, 255},
                                         Format{".tif", CV_8U, 255}, Format{".bmp", CV_8U, 255},
                                         Format{".PNG", CV_16U, 65535},
                                         Format{".pgm", CV_16U, 65535},
                                         Format{".tiff", CV_16U, 65535}, Format{".exr", CV_32F, 1},
                                         Format{".tiff", CV_32F, 1}, Format{".pfm", CV_32F, 1},
                                         Format{".tiff", CV_64F, 1}));

TEST_P(PictureFormatTest, gives_the_same_intensity_from_every_format) {
  const Format& format = GetParam();
  write_two(format.extension, scaled(codes(), format.type, format.white / 255));
  const cv::Mat expected = scaled(codes(), CV_32F, 1.0 / 255);
  EXPECT_THAT(first_frame(),
              Pointwise(FloatNear(kRounding),
                        std::vector<float>(expected.begin<float>(), expected.end<float>())));
}

TEST_F(PictureFolderTest, reads_the_lossy_formats_near_enough) {
  const cv::Mat gray(16, 16, CV_8U, cv::Scalar(100));
  write_two(".jpg", gray);
  // A flat picture: JPEG is off by a rounding of a code or two.
  EXPECT_THAT(first_frame(), Each(FloatNear(100 / 255.0f, 2 / 255.0f)));
}

TEST_F(PictureFolderTest, weighs_colours_by_bt_709_and_leaves_alpha_out) {
  const cv::Mat colours =
      (cv::Mat_<cv::Vec4b>(1, 4) << cv::Vec4b(255, 0, 0, 0), cv::Vec4b(0, 255, 0, 10),
       cv::Vec4b(0, 0, 255, 255), cv::Vec4b(255, 255, 255, 0));
  write_two(".png", colours);
  EXPECT_THAT(first_frame(),
              ElementsAre(FloatNear(0.0722f, kRounding), FloatNear(0.7152f, kRounding),
                          FloatNear(0.2126f, kRounding), FloatNear(1.0f, kRounding)));
}

TEST_F(PictureFolderTest, takes_white_in_floats_from_the_options) {
  write_two(".exr", cv::Mat(1, 2, CV_32F, cv::Scalar(3.0)));
  options.float_white = 4.0;
  EXPECT_THAT(first_frame(), ElementsAre(0.75f, 0.75f));
}

TEST_F(PictureFolderTest, takes_pictures_in_natural_order_and_passes_other_files_over) {
  for (const int number : {10, 2, 1, 9})
    write("frame" + std::to_string(number) + ".png", cv::Mat(1, 1, CV_8U, cv::Scalar(number)));
  std::ofstream(folder_ / "notes.txt") << "not a picture";
  std::ofstream(folder_ / ".frame3.png") << "hidden";
  std::filesystem::create_directory(folder_ / "frame4.png");
  const auto frames = open();
  EXPECT_EQ(frames->announced_frames(), 4);
  EXPECT_EQ(frames->rate_hz(), 100);
  std::vector<long> codes;
  for (core::Image<float> frame; frames->next(frame);)
    codes.push_back(std::lround(255 * frame(0, 0)));
  EXPECT_THAT(codes, ElementsAre(1, 2, 9, 10));
}

TEST_F(PictureFolderTest, resizes_by_averaging_over_the_area) {
  write_two(".exr", (cv::Mat_<float>(2, 4) << 1, 2, 5, 6, 3, 4, 7, 8));
  options.size = {2, 1};
  EXPECT_THAT(first_frame(), ElementsAre(FloatNear(2.5f, 1e-5f), FloatNear(6.5f, 1e-5f)));
}

TEST_F(PictureFolderTest, counts_what_is_no_intensity_before_resizing) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  write_two(".exr", (cv::Mat_<float>(1, 8) << -2, 4, kNan, 1, kInf, -kInf, 1e21f, 1));
  options.size = {4, 1};
  const auto frames = open();
  core::Image<float> frame;
  ASSERT_TRUE(frames->next(frame));
  EXPECT_FLOAT_EQ(frame(0, 0), 2.0f);  // of 0 and 4: a negative value darkens no neighbour
  EXPECT_TRUE(std::isnan(frame(1, 0)));
  EXPECT_TRUE(std::isnan(frame(2, 0)));
  EXPECT_TRUE(std::isnan(frame(3, 0)));
  EXPECT_EQ(frames->bad_values(), 5u);
}

TEST_F(PictureFolderTest, takes_minus_zero_for_zero_and_the_greatest_light_as_it_is) {
  write_two(".exr", (cv::Mat_<float>(1, 2) << -0.0f, 1e20f));
  const auto frames = open();
  core::Image<float> frame;
  ASSERT_TRUE(frames->next(frame));
  EXPECT_EQ(frame(0, 0), 0.0f);
  EXPECT_FALSE(std::signbit(frame(0, 0)));
  EXPECT_EQ(frame(1, 0), 1e20f);
  EXPECT_EQ(frames->bad_values(), 0u);
}

TEST_F(PictureFolderTest, names_the_picture_that_has_another_size) {
  write("frame1.png", codes());
  write("frame2.png", codes().t());
  EXPECT_THAT(reading(),
              ThrowsMessage<std::invalid_argument>(testing::AllOf(
                  HasSubstr("frame2.png: 2x4 px, expected 4x2 as in "), EndsWith("frame1.png"))));
}

TEST_F(PictureFolderTest, names_the_picture_that_cannot_be_read) {
  write("frame1.png", codes());
  std::ofstream(folder_ / "frame2.png") << "this is no picture";
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(
                             EndsWith("frame2.png: cannot be read as a picture")));
  std::ofstream(folder_ / "frame2.png") << std::flush;  // empty
  EXPECT_THROW(reading()(), std::invalid_argument);
}

TEST_F(PictureFolderTest, refuses_pixels_of_another_kind) {
  write_two(".tiff", cv::Mat(2, 2, CV_16S, cv::Scalar(1)));
  EXPECT_THAT(reading(),
              ThrowsMessage<std::invalid_argument>(HasSubstr("frame1.tiff: pixels of CV_16S")));
}

TEST_F(PictureFolderTest, refuses_a_folder_with_too_few_pictures) {
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(
                             HasSubstr(": 0 pictures, needed at least 2 (.png .tif")));
  write("frame1.png", codes());
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(HasSubstr(": 1 pictures")));
}

// Root reads every folder, so that one which is not there stands for one not to be read.
TEST_F(PictureFolderTest, names_a_folder_that_cannot_be_read) {
  EXPECT_THAT([&] { PictureFolder(folder_ / "none", options); },
              ThrowsMessage<std::invalid_argument>(
                  EndsWith("none: cannot be read, No such file or directory")));
}

TEST_F(PictureFolderTest, refuses_pictures_of_several_kinds) {
  write("frame1.png", codes());
  write("frame1_depth.tiff", scaled(codes(), CV_32F, 1));
  EXPECT_THAT(reading(),
              ThrowsMessage<std::invalid_argument>(HasSubstr(
                  ": holds frame1.png and frame1_depth.tiff, expected pictures of one kind")));
}

TEST_F(PictureFolderTest, refuses_options_out_of_range_and_a_missing_rate) {
  write_two(".png", codes());
  options.rate_hz = std::nullopt;
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(HasSubstr("fps is needed")));
  for (const double rate_hz : {0.0, -1.0, 2e6, std::nan("")}) {
    options.rate_hz = rate_hz;
    EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(HasSubstr("fps = "))) << rate_hz;
  }
  options.rate_hz = 10;
  options.size = {0, 5};
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(HasSubstr("size.width_px = 0")));
  options.size = std::nullopt;
  options.float_white = 0;
  EXPECT_THAT(reading(), ThrowsMessage<std::invalid_argument>(HasSubstr("white = 0")));
}

TEST_F(PictureFolderTest, refuses_what_is_neither_folder_nor_video) {
  write("frame1.png", codes());
  EXPECT_THAT([&] { open_frames(folder_ / "none", options); },
              ThrowsMessage<std::invalid_argument>(EndsWith("none: no such file or folder")));
  EXPECT_THAT([&] { open_frames(folder_ / "frame1.png", options); },
              ThrowsMessage<std::invalid_argument>(
                  EndsWith("frame1.png: one picture, expected a folder of them or a video")));
}

}  // namespace
}  // namespace nightjar::camera
