#pragma once

#include <cmath>
#include <optional>

#include "core/image.h"

namespace nightjar::esi {

/// Which pixels a sharpness is measured at: those of every (2 step)th row, against their
/// neighbours to the right and below.
struct SharpnessRows {
  int step = 1;

  /// At most 32 rows of a picture that high: a measure needs no more.
  static SharpnessRows of(int height_px);
  /// Whether a pixel of this row is looked at, be it as a neighbour.
  bool takes(int y) const { return y / 2 % step == 0; }
};

/// Sum of g^2 over (sum of g)^2 for the absolute differences g between neighbours, where one
/// of them is not `still` (1 for a pixel that is, else 0): the normalised sparsity of Krishnan
/// et al. (CVPR 2011), L2/L1, squared. Whether an edge stays blurred or is overdone, its
/// change is spread over more pixels, and this falls. 0 where there is no difference at all.
double sharpness(const core::Image<float>& picture, const core::Image<float>& still,
                 SharpnessRows rows);

/// Where `value` has its first maximum above `least`: the lowest of 12 places, evenly spaced on
/// a logarithmic scale from `least` > 0 to `greatest`, that beats both its neighbours, then
/// golden sections, to 2 % where there is one maximum between the neighbours. None where no
/// place does.
template <class Function>
std::optional<double> first_maximum(double least, double greatest, Function value) {
  constexpr int kPlaces = 12, kSections = 5;
  constexpr double kGolden = 0.6180339887498949;
  const double step = std::log(greatest / least) / (kPlaces - 1);
  const auto at = [&](double steps) { return value(least * std::exp(steps * step)); };
  double before = at(0), here = at(1);
  int i = 1;
  for (; i + 1 < kPlaces; ++i) {
    const double after = at(i + 1);
    if (here > before && here > after) break;
    before = here, here = after;
  }
  if (i + 1 == kPlaces) return std::nullopt;
  double low = i - 1, high = i + 1;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = at(a), at_b = at(b);
  for (int k = 0; k < kSections; ++k) {
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a;
      at_a = at(a = high - kGolden * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = at(b = low + kGolden * (high - low));
    }
  }
  return least * std::exp((at_a > at_b ? a : b) * step);
}

}  // namespace nightjar::esi
