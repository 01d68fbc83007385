#include "scenarios/gray_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <vector>

#include "core/part_file.h"

namespace nightjar::scenarios {

core::Image<std::uint8_t> read_gray_picture(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);  // imread() prints what it does not find
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  cv::Mat mat;
  try {
    if (!bytes.empty()) mat = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {  // a size beyond its limits, for one
  }
  if (mat.empty())
    throw std::invalid_argument(fmt::format("{}: cannot be read as a picture", path.string()));
  core::Image<std::uint8_t> gray({mat.cols, mat.rows});
  for (int y = 0; y < mat.rows; ++y)
    std::copy_n(mat.ptr(y), mat.cols, gray.pixels().data() + std::ptrdiff_t{y} * mat.cols);
  return gray;
}

void write_png(const std::filesystem::path& path, const core::Image<std::uint8_t>& gray) {
  const cv::Mat mat(gray.height(), gray.width(), CV_8U,
                    const_cast<std::uint8_t*>(gray.pixels().data()));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", mat, png);
  core::PartFile file(path);
  file.stream().write(reinterpret_cast<const char*>(png.data()),
                      static_cast<std::streamsize>(png.size()));
  file.finish();
}

}  // namespace nightjar::scenarios
