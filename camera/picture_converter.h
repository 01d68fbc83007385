#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/image.h"

namespace cv {
class Mat;
}

namespace nightjar::camera {

/// Turns decoded pictures of one size into linear intensity, 1 = white.
class PictureConverter {
 public:
  /// White is 255 or 65535 in pictures of whole numbers, `float_white` in those of
  /// floats. The result has the pictures' own size unless `size` is given.
  PictureConverter(double float_white, std::optional<core::Resolution> size)
      : float_white_(float_white), size_(size) {}

  /// `picture`: 8-bit, 16-bit, float or double; gray, BGR or BGRA. Negative intensity
  /// becomes 0; NaN, infinity and what is beyond +-1e20 (more than any light) become NaN;
  /// both are counted before resizing.
  /// Throws std::invalid_argument, which begins with `name`, for any other kind and for
  /// another size than the first picture's.
  void convert(const cv::Mat& picture, const std::string& name, core::Image<float>& intensity);

  std::uint64_t bad_values() const { return bad_values_; }

 private:
  void check_size(const cv::Mat& picture, const std::string& name);
  void correct(cv::Mat& luminance);

  double float_white_;
  std::optional<core::Resolution> size_;
  core::Resolution first_size_;  ///< Of the first picture, empty before it.
  std::string first_name_;
  std::uint64_t bad_values_ = 0;
};

}  // namespace nightjar::camera
