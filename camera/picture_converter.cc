#include "camera/picture_converter.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace nightjar::camera {
namespace {

// Rec. ITU-R BT.709, in OpenCV's order.
constexpr float kBlue = 0.0722f, kGreen = 0.7152f, kRed = 0.2126f;

// More than any light, and all that an emulated pixel takes.
constexpr float kMostIntensity = 1e20f;

double white_of(const cv::Mat& picture, double float_white, const std::string& name) {
  switch (picture.depth()) {
    case CV_8U: return 255;
    case CV_16U: return 65535;
    case CV_32F:
    case CV_64F: return float_white;
    default:
      throw std::invalid_argument(
          fmt::format("{}: pixels of {}, allowed 8-bit, 16-bit (unsigned) and float", name,
                      cv::depthToString(picture.depth())));
  }
}

/// One channel of floats, 1 = white.
cv::Mat luminance_of(const cv::Mat& picture, double white, const std::string& name) {
  const int channels = picture.channels();
  cv::Mat scaled;
  picture.convertTo(scaled, CV_32F, 1 / white);
  if (channels == 1) return scaled;
  if (channels != 3 && channels != 4)
    throw std::invalid_argument(fmt::format("{}: {} channels, allowed 1, 3 and 4", name, channels));
  const cv::Mat weights = (cv::Mat_<float>(1, 4) << kBlue, kGreen, kRed, 0);
  cv::Mat luminance;
  cv::transform(scaled, luminance, weights.colRange(0, channels));
  return luminance;
}

}  // namespace

void PictureConverter::check_size(const cv::Mat& picture, const std::string& name) {
  const core::Resolution size{picture.cols, picture.rows};
  if (first_name_.empty()) {
    first_size_ = size;
    first_name_ = name;
  }
  if (size != first_size_)
    throw std::invalid_argument(fmt::format("{}: {}x{} px, expected {}x{} as in {}", name,
                                            size.width_px, size.height_px, first_size_.width_px,
                                            first_size_.height_px, first_name_));
}

void PictureConverter::correct(cv::Mat& luminance) {
  for (float& value : cv::Mat_<float>(luminance)) {
    if (value > 0 && value <= kMostIntensity) continue;
    if (value != 0) ++bad_values_;
    // Also of -0, which would not be the same bits as 0.
    value = std::abs(value) <= kMostIntensity ? 0 : std::numeric_limits<float>::quiet_NaN();
  }
}

void PictureConverter::convert(const cv::Mat& picture, const std::string& name,
                               core::Image<float>& intensity) {
  check_size(picture, name);
  cv::Mat luminance = luminance_of(picture, white_of(picture, float_white_, name), name);
  if (picture.depth() == CV_32F || picture.depth() == CV_64F) correct(luminance);
  const core::Resolution size = size_.value_or(first_size_);
  if (intensity.size() != size) intensity = core::Image<float>(size);
  cv::Mat out(size.height_px, size.width_px, CV_32F, intensity.pixels().data());
  if (size == first_size_)
    luminance.copyTo(out);
  else
    cv::resize(luminance, out, out.size(), 0, 0, cv::INTER_AREA);
}

}  // namespace nightjar::camera
