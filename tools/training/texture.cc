#include "tools/training/texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace nightjar::training {
namespace {

/// Noise of one deviation in octaves down to the finest, as of surfaces near and far: the finer
/// the fainter, if at all, and drawn out along one side, as of wood, in one of three.
cv::Mat draw_fractal(int side_px, int coarsest_cells, core::Random& random) {
  cv::Mat sum(side_px, side_px, CV_32F, cv::Scalar(0));
  const double fading = between(0, 0.7, random);
  const double stretch = random() % 3 != 0 ? 1 : log_between(1, 16, random);
  cv::RNG numbers(random());
  for (int cells = coarsest_cells; cells <= side_px / 2; cells *= 2) {
    cv::Mat coarse(cells, std::max(4, static_cast<int>(cells / stretch)), CV_32F), fine;
    numbers.fill(coarse, cv::RNG::NORMAL, 0, std::pow(cells, -fading) * between(0.5, 1, random));
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_CUBIC);
    sum += fine;
  }
  cv::Scalar mean, deviation;
  cv::meanStdDev(sum, mean, deviation);
  return (sum - mean) / deviation[0];
}

/// Even grey times e to the power of noise.
cv::Mat draw_ground(int side_px, core::Random& random) {
  const double shade = between(0.05, 0.9, random), amplitude_log = log_between(0.03, 0.8, random);
  cv::Mat ground;
  cv::exp(amplitude_log * draw_fractal(side_px, 8, random), ground);
  return cv::min(shade * ground, 0.98f);
}

void draw_shape(cv::Mat& scene, core::Random& random) {
  const int side_px = scene.rows;
  const cv::Scalar shade(log_between(0.03, 0.95, random));
  const cv::Point place(whole_between(0, side_px, random), whole_between(0, side_px, random));
  const int size_px = static_cast<int>(log_between(8, 400, random));
  const auto near = [&](int reach_px) {
    return place + cv::Point(whole_between(-reach_px, reach_px, random),
                             whole_between(-reach_px, reach_px, random));
  };
  switch (whole_between(0, 4, random)) {
    case 0:
      cv::circle(scene, place, size_px, shade, random() % 2 ? -1 : whole_between(2, 12, random),
                 cv::LINE_AA);
      break;
    case 1: {
      std::vector<cv::Point> corners(whole_between(3, 7, random));
      for (cv::Point& corner : corners) corner = near(size_px);
      cv::fillPoly(scene, corners, shade, cv::LINE_AA);
      break;
    }
    case 2:
      cv::line(scene, place, near(900), shade, whole_between(2, 24, random), cv::LINE_AA);
      break;
    case 3:
      cv::ellipse(scene, place,
                  {size_px, std::max(4, static_cast<int>(size_px * between(0.2, 1.0, random)))},
                  between(0, 360, random), 0, 360, shade, -1, cv::LINE_AA);
      break;
    default: {
      std::string letters;
      for (int i = 0; i < 3; ++i) letters += static_cast<char>(whole_between(33, 122, random));
      cv::putText(scene, letters, place, whole_between(0, 7, random), log_between(0.8, 8, random),
                  shade, whole_between(1, 12, random), cv::LINE_AA);
    }
  }
}

/// Noise on every surface, as of asphalt, wood or cloth.
void add_grain(cv::Mat& scene, core::Random& random) {
  const double amplitude_log = log_between(0.01, 0.3, random);
  const int coarsest_cells = static_cast<int>(log_between(8, 512, random));
  cv::Mat grain;
  cv::exp(amplitude_log * draw_fractal(scene.rows, coarsest_cells, random), grain);
  cv::min(scene.mul(grain), 0.98, scene);
}

/// A square of random cells in a black frame, most with a white margin.
void draw_grid(cv::Mat& scene, core::Random& random) {
  const int cells = whole_between(5, 10, random);
  const double cell_px = log_between(6, 44, random);
  const double turn_rad = between(0, 2 * std::numbers::pi, random);
  const cv::Point2d origin(between(0, scene.cols, random), between(0, scene.rows, random));
  const double black = between(0.02, 0.12, random), white = between(0.45, 0.95, random);
  constexpr int kShift = 4;  // OpenCV's places then count sixteenths
  const auto corner = [&](double x, double y) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    return cv::Point(static_cast<int>(16 * (origin.x + cell_px * (x * c - y * s))),
                     static_cast<int>(16 * (origin.y + cell_px * (x * s + y * c))));
  };
  const auto fill = [&](double x0, double y0, double x1, double y1, double shade) {
    const std::vector<cv::Point> corners{corner(x0, y0), corner(x1, y0), corner(x1, y1),
                                         corner(x0, y1)};
    cv::fillConvexPoly(scene, corners, cv::Scalar(shade), cv::LINE_AA, kShift);
  };
  if (random() % 4 != 0) fill(-1, -1, cells + 1, cells + 1, white);
  fill(0, 0, cells, cells, black);
  for (int y = 1; y < cells - 1; ++y)
    for (int x = 1; x < cells - 1; ++x)
      if (random() % 2 != 0) fill(x, y, x + 1, y + 1, white);
}

}  // namespace

double between(double least, double greatest, core::Random& random) {
  return least + (greatest - least) * core::uniform01(random);
}

double log_between(double least, double greatest, core::Random& random) {
  return std::exp(between(std::log(least), std::log(greatest), random));
}

int whole_between(int least, int greatest, core::Random& random) {
  return least + static_cast<int>(random() % static_cast<unsigned>(greatest - least + 1));
}

core::Image<float> draw_texture(int side_px, core::Random& random) {
  cv::Mat scene = draw_ground(2 * side_px, random);
  for (int n = whole_between(10, 220, random); n > 0; --n) draw_shape(scene, random);
  const bool full_of_grids = random() % 2 != 0;
  for (int n = whole_between(2, full_of_grids ? 160 : 26, random); n > 0; --n)
    draw_grid(scene, random);
  if (random() % 2 != 0) add_grain(scene, random);
  core::Image<float> texture({side_px, side_px});
  cv::Mat pixels(side_px, side_px, CV_32F, texture.pixels().data());
  cv::resize(scene, pixels, pixels.size(), 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(pixels, pixels, {0, 0}, between(0.2, 1.2, random));
  cv::max(pixels, 0.01, pixels);
  return texture;
}

}  // namespace nightjar::training
