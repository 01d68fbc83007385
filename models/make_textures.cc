// Draws the textures of models/textures anew: make_textures FOLDER.
// They are committed, so that a scene needs no program to be loaded; this is how
// they came about. tests/tracker/tag_image_test.cc holds the tag against libapriltag.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/random.h"
#include "tracker/tag_image.h"

namespace {

using nightjar::core::Image;
using nightjar::core::Random;

/// Smooth noise of a given number of lattice cells a side, periodic, in [0, 1).
class PeriodicNoise {
 public:
  PeriodicNoise(int cells_x, int cells_y, Random& random)
      : cells_x_(cells_x), cells_y_(cells_y), values_(static_cast<std::size_t>(cells_x * cells_y)) {
    for (double& v : values_) v = nightjar::core::uniform01(random);
  }

  /// u, v in [0, 1) over one period.
  double operator()(double u, double v) const {
    const double x = u * cells_x_, y = v * cells_y_;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double a = ease(x - i), b = ease(y - j);
    return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
           b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
  }

 private:
  static double ease(double t) { return t * t * (3 - 2 * t); }
  double at(int i, int j) const {
    return values_[static_cast<std::size_t>((j % cells_y_) * cells_x_ + i % cells_x_)];
  }

  int cells_x_, cells_y_;
  std::vector<double> values_;
};

void save(const std::string& path, const Image<std::uint8_t>& image) {
  const cv::Mat mat(image.height(), image.width(), CV_8U,
                    const_cast<std::uint8_t*>(image.pixels().data()));
  if (!cv::imwrite(path, mat)) throw std::runtime_error("cannot write " + path);
  std::cout << path << '\n';
}

std::uint8_t gray(double reflectance) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(reflectance, 0.0, 1.0)));
}

/// Worn concrete slabs, four by four to the tile: blotches, speckle, dark joints.
Image<std::uint8_t> floor_image(int size_px) {
  Random random = nightjar::core::random_stream(1, "floor");
  std::vector<PeriodicNoise> octaves;
  for (const int cells : {8, 24, 72, 200, 400}) octaves.emplace_back(cells, cells, random);
  const std::vector<double> weights = {0.16, 0.14, 0.14, 0.16, 0.16};
  constexpr int kSlabs = 4;
  std::vector<double> slab_tone(kSlabs * kSlabs);
  for (double& tone : slab_tone) tone = 0.16 * (nightjar::core::uniform01(random) - 0.5);

  Image<std::uint8_t> image({size_px, size_px});
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const double u = (x + 0.5) / size_px, v = (y + 0.5) / size_px;
      double value = 0.42;
      for (std::size_t o = 0; o < octaves.size(); ++o)
        value += weights[o] * (octaves[o](u, v) - 0.5);
      const int i = static_cast<int>(u * kSlabs), j = static_cast<int>(v * kSlabs);
      value += slab_tone[static_cast<std::size_t>(j * kSlabs + i)];
      const double joint_u = std::abs(u * kSlabs - std::round(u * kSlabs));
      const double joint_v = std::abs(v * kSlabs - std::round(v * kSlabs));
      if (std::min(joint_u, joint_v) < 0.008) value *= 0.45;
      image(x, y) = gray(value);
    }
  return image;
}

/// Planks along u with grain.
Image<std::uint8_t> wood_image(int size_px) {
  Random random = nightjar::core::random_stream(1, "wood");
  const PeriodicNoise grain(4, 96, random), waves(3, 12, random);
  constexpr int kPlanks = 5;
  Image<std::uint8_t> image({size_px, size_px});
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const double u = (x + 0.5) / size_px, v = (y + 0.5) / size_px;
      double value = 0.46 + 0.14 * (grain(u, v) - 0.5) + 0.10 * (waves(u, v) - 0.5);
      const double joint = std::abs(v * kPlanks - std::round(v * kPlanks));
      if (joint < 0.02) value *= 0.6;
      image(x, y) = gray(value);
    }
  return image;
}

/// The landing board seen from above, its front edge at the top: planks, and in the
/// middle, half as wide as the board, the tag with its white border. One picture, so
/// that the tag's outer edge is filtered like a texture and not cut like a geom.
/// Matte ink and paper are neither fully black nor fully white.
Image<std::uint8_t> board_image(int cell_px) {
  const Image<std::uint8_t> tag = nightjar::tracker::tag_image(0, cell_px);
  Image<std::uint8_t> board = wood_image(2 * tag.width());
  for (int y = 0; y < tag.height(); ++y)
    for (int x = 0; x < tag.width(); ++x)
      board(x + tag.width() / 2, y + tag.height() / 2) = gray(tag(x, y) > 127 ? 0.85 : 0.05);
  return board;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string folder = argc > 1 ? argv[1] : "models/textures";
  save(folder + "/board.png", board_image(32));
  save(folder + "/floor.png", floor_image(1024));
  save(folder + "/wood.png", wood_image(512));
  return 0;
} catch (const std::exception& e) {
  std::cerr << "make_textures: " << e.what() << '\n';
  return 2;
}
