#include "camera/picture_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <system_error>

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
  std::error_code error, ignored;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::filesystem::path& path = entry->path();
    const bool hidden = path.filename().string().starts_with('.');
    if (!hidden && entry->is_regular_file(ignored) && is_picture(path)) pictures.push_back(path);
  }
  if (error)
    throw std::invalid_argument(
        fmt::format("{}: cannot be read, {}", folder.string(), error.message()));
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
}

bool PictureFolder::next(core::Image<float>& intensity) {
  if (next_ == pictures_.size()) return false;
  const std::filesystem::path& path = pictures_[next_++];
  converter_.convert(read(path), path.string(), intensity);
  return true;
}

}  // namespace nightjar::camera
