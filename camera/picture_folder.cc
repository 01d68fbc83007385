#include "camera/picture_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "camera/natural_order.h"

namespace nightjar::camera {
namespace {

constexpr std::array kExtensions = {".png",  ".tif", ".tiff", ".pgm", ".ppm", ".pnm", ".jpg",
                                    ".jpeg", ".bmp", ".webp", ".exr", ".hdr", ".pfm"};

std::string lower_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool hidden = entry.path().filename().string().starts_with('.');
    if (!hidden && entry.is_regular_file() && is_picture(entry.path()))
      pictures.push_back(entry.path());
  }
  std::sort(pictures.begin(), pictures.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return pictures;
}

/// Two kinds in one folder are hardly one sequence: colour beside depth, or the same
/// frames twice.
void check_kinds(const std::vector<std::filesystem::path>& pictures) {
  const auto other = std::find_if(pictures.begin(), pictures.end(), [&](const auto& picture) {
    return lower_extension(picture) != lower_extension(pictures.front());
  });
  if (other == pictures.end()) return;
  throw std::invalid_argument(fmt::format(
      "{}: holds {} and {}, expected pictures of one kind", other->parent_path().string(),
      pictures.front().filename().string(), other->filename().string()));
}

cv::Mat read(const std::filesystem::path& path) {
  try {
    cv::Mat picture = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    if (!picture.empty()) return picture;
  } catch (const cv::Exception&) {  // says no more than the empty picture does
  }
  throw std::invalid_argument(fmt::format("{}: cannot be read as a picture", path.string()));
}

}  // namespace

bool is_picture(const std::filesystem::path& path) {
  return std::find(kExtensions.begin(), kExtensions.end(), lower_extension(path)) !=
         kExtensions.end();
}

PictureFolder::PictureFolder(const std::filesystem::path& folder, const FrameOptions& options)
    : pictures_(pictures_in(folder)), converter_(options.float_white, options.size) {
  if (pictures_.size() < 2)
    throw std::invalid_argument(fmt::format("{}: {} pictures, needed at least 2 ({})",
                                            folder.string(), pictures_.size(),
                                            fmt::join(kExtensions, " ")));
  check_kinds(pictures_);
  if (!options.rate_hz)
    throw std::invalid_argument(
        fmt::format("{}: pictures have no frame rate, fps is needed", folder.string()));
  rate_hz_ = *options.rate_hz;
  // Off in OpenCV as released (on in Debian's); it looks once, when it meets its first EXR.
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
}

bool PictureFolder::next(core::Image<float>& intensity) {
  if (next_ == pictures_.size()) return false;
  const std::filesystem::path& path = pictures_[next_++];
  converter_.convert(read(path), path.string(), intensity);
  return true;
}

}  // namespace nightjar::camera
