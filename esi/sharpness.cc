#include "esi/sharpness.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nightjar::esi {
namespace {

/// Sums in eight lanes, for the compiler to make vectors of.
struct Sums {
  static constexpr int kLanes = 8;
  std::array<float, kLanes> g{};
  std::array<float, kLanes> g2{};

  [[gnu::always_inline]] void add(int lane, float difference, float weight) {
    const float change = std::abs(difference) * weight;
    const auto i = static_cast<std::size_t>(lane);
    g[i] += change;
    g2[i] += change * change;
  }
};

/// A row against the pixel to the right and, at `below` elements on, the one below.
void add_row(const float* picture, const float* still, int below, int count, Sums& sums) {
  Sums s = sums;
  for (int x = 0; x < count; x += Sums::kLanes) {
    const int lanes = std::min(Sums::kLanes, count - x);
    const auto take = [&](int lane) {
      const float* p = picture + x + lane;
      const float* at = still + x + lane;
      s.add(lane, p[1] - p[0], 1.0f - at[0] * at[1]);
      s.add(lane, p[below] - p[0], 1.0f - at[0] * at[below]);
    };
    if (lanes == Sums::kLanes)
      for (int lane = 0; lane < Sums::kLanes; ++lane) take(lane);
    else
      for (int lane = 0; lane < lanes; ++lane) take(lane);
  }
  sums = s;
}

}  // namespace

SharpnessRows SharpnessRows::of(int height_px) {
  constexpr int kRows = 32;
  return {std::max(1, (height_px / 2 + kRows - 1) / kRows)};
}

double sharpness(const core::Image<float>& picture, const core::Image<float>& still,
                 SharpnessRows rows) {
  const int width = picture.width();
  double g = 0, g2 = 0;
  for (int y = 0; y + 1 < picture.height(); y += 2 * rows.step) {
    Sums sums;
    add_row(&picture(0, y), &still(0, y), width, width - 1, sums);
    for (const float sum : sums.g) g += static_cast<double>(sum);
    for (const float sum : sums.g2) g2 += static_cast<double>(sum);
  }
  return g > 0 ? g2 / (g * g) : 0.0;
}

}  // namespace nightjar::esi
