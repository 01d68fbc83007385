#include "esi/channel_scaling.h"

#include <algorithm>
#include <cassert>

namespace nightjar::esi {

void halve(const ChannelImage& in, ChannelImage& out, int first) {
  assert(out.width() == halved(in.width()) && out.height() == halved(in.height()));
  assert(first + in.channels() <= out.channels());
  for (int y = 0; y < out.height(); ++y) {
    const int lower = std::min(2 * y + 1, in.height() - 1);
    for (int x = 0; x < out.width(); ++x) {
      const int right = std::min(2 * x + 1, in.width() - 1);
      const std::int16_t *a = in.at(2 * x, 2 * y), *b = in.at(right, 2 * y);
      const std::int16_t *c = in.at(2 * x, lower), *d = in.at(right, lower);
      std::int16_t* __restrict to = out.at(x, y) + first;
      for (int k = 0; k < in.channels(); ++k) {
        const auto sum = static_cast<std::int16_t>(a[k] + b[k] + c[k] + d[k] + 2);
        to[k] = static_cast<std::int16_t>(sum >> 2);
      }
    }
  }
}

void add_doubled(const ChannelImage& in, ChannelImage& out) {
  assert(in.width() == halved(out.width()) && in.height() == halved(out.height()));
  assert(out.channels() == in.channels());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const std::int16_t* from = in.at(x / 2, y / 2);
      std::int16_t* __restrict to = out.at(x, y);
      for (int k = 0; k < in.channels(); ++k) to[k] = static_cast<std::int16_t>(to[k] + from[k]);
    }
}

void double_smoothly(const core::Image<std::int32_t>& in, core::Image<std::int32_t>& out) {
  assert(in.width() == halved(out.width()) && in.height() == halved(out.height()));
  const auto next_to = [](int at, int side) {
    return std::clamp(at / 2 + at % 2 * 2 - 1, 0, side - 1);
  };
  for (int y = 0; y < out.height(); ++y) {
    const int near = y / 2, far = next_to(y, in.height());
    for (int x = 0; x < out.width(); ++x) {
      const int beside = next_to(x, in.width());
      out(x, y) =
          (9 * in(x / 2, near) + 3 * (in(beside, near) + in(x / 2, far)) + in(beside, far) + 8) >>
          4;
    }
  }
}

}  // namespace nightjar::esi
