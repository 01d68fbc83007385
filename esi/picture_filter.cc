#include "esi/picture_filter.h"

#include <cmath>
#include <cstdlib>

#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

/// Per unit of filter_sigma, in pixels and in grey levels: the original's choice.
constexpr double kBilateralScale = 20;

float gaussian(double distance, double sigma) {
  return static_cast<float>(std::exp(-distance * distance / (2 * sigma * sigma)));
}

/// The index in [0, n) that mirroring takes `i` to.
int mirrored(int i, int n) {
  if (n == 1) return 0;
  while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
  return i;
}

}  // namespace

PictureFilter::PictureFilter(SpatialFilter kind, double sigma) : kind_(kind) {
  float sum = 0;
  for (int d = -kReach_px; d <= kReach_px; ++d)
    sum += gaussian_[static_cast<std::size_t>(d + kReach_px)] = gaussian(d, sigma);
  for (float& weight : gaussian_) weight /= sum;

  const double scale = sigma * kBilateralScale;
  for (int dy = -kReach_px; dy <= kReach_px; ++dy)
    for (int dx = -kReach_px; dx <= kReach_px; ++dx)
      if (dx * dx + dy * dy <= kReach_px * kReach_px)
        taps_.push_back({dx, dy, gaussian(std::hypot(dx, dy), scale)});
  for (std::size_t d = 0; d < of_difference_.size(); ++d)
    of_difference_[d] = gaussian(static_cast<double>(d), scale);
}

void PictureFilter::apply(core::Image<std::uint8_t>& gray) {
  if (kind_ == SpatialFilter::none) return;
  pad(gray);
  if (kind_ == SpatialFilter::gaussian)
    blur(gray);
  else
    smooth_but_edges(gray);
}

void PictureFilter::pad(const core::Image<std::uint8_t>& gray) {
  const core::Resolution size{gray.width() + 2 * kReach_px, gray.height() + 2 * kReach_px};
  if (padded_.size() != size) {
    padded_ = core::Image<std::uint8_t>(size);
    rows_ = core::Image<float>({gray.width(), size.height_px});
  }
  for (int y = 0; y < size.height_px; ++y) {
    const std::uint8_t* from = &gray(0, mirrored(y - kReach_px, gray.height()));
    std::uint8_t* to = &padded_(0, y);
    for (int x = 0; x < size.width_px; ++x) to[x] = from[mirrored(x - kReach_px, gray.width())];
  }
}

void PictureFilter::blur(core::Image<std::uint8_t>& gray) {
  const auto w = gaussian_;
  const int width = gray.width();
  for (int y = 0; y < padded_.height(); ++y) {
    const std::uint8_t* from = &padded_(0, y);
    float* to = &rows_(0, y);
#pragma GCC ivdep
    for (int x = 0; x < width; ++x)
      to[x] = w[0] * static_cast<float>(from[x]) + w[1] * static_cast<float>(from[x + 1]) +
              w[2] * static_cast<float>(from[x + 2]) + w[3] * static_cast<float>(from[x + 3]) +
              w[4] * static_cast<float>(from[x + 4]);
  }
  for (int y = 0; y < gray.height(); ++y) {
    const float* from = &rows_(0, y);
    std::uint8_t* to = &gray(0, y);
#pragma GCC ivdep
    for (int x = 0; x < width; ++x)
      to[x] = to_gray(w[0] * from[x] + w[1] * from[x + width] + w[2] * from[x + 2 * width] +
                      w[3] * from[x + 3 * width] + w[4] * from[x + 4 * width]);
  }
}

void PictureFilter::smooth_but_edges(core::Image<std::uint8_t>& gray) const {
  for (int y = 0; y < gray.height(); ++y)
    for (int x = 0; x < gray.width(); ++x) {
      const int middle = gray(x, y);
      float sum = 0, weights = 0;
      for (const Tap& tap : taps_) {
        const int level = padded_(x + kReach_px + tap.dx, y + kReach_px + tap.dy);
        const float weight =
            tap.weight * of_difference_[static_cast<std::size_t>(std::abs(level - middle))];
        sum += weight * static_cast<float>(level);
        weights += weight;
      }
      gray(x, y) = to_gray(sum / weights);
    }
}

}  // namespace nightjar::esi
