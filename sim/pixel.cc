#include "sim/pixel.h"

#include <algorithm>
#include <cmath>

namespace nightjar::sim {

ResidualCourse::ResidualCourse(double change, double leak, double lag, double residual, double rate)
    : slope_(change + leak),
      // d lag/ds = -rate lag - change, so lag(s) = bend exp(-rate s) - change/rate.
      bend_(rate > 0 ? lag + change / rate : 0),
      rate_(rate),
      leak_(leak),
      bent_at_end_(rate > 0 ? bend_ * std::exp(-rate) : 0) {
  offset_ = residual - bend_;
}

double ResidualCourse::bent(double s) const {
  if (s == 1) return bent_at_end_;
  return s == 0 || rate_ == 0 ? bend_ : bend_ * std::exp(-rate_ * s);
}

void ResidualCourse::change_leak(double s, double leak) {
  offset_ -= (leak - leak_) * s;
  slope_ += leak - leak_;
  leak_ = leak;
}

double ResidualCourse::crossing(double from, double to, double level, double tolerance) const {
  const double sign = level < 0 ? -1.0 : 1.0;  // misses below count as negative
  const double miss_from = sign * (residual(from) - level);
  const double miss_to = sign * (residual(to) - level);
  if (miss_from >= 0) return from;
  if (miss_to <= 0) return to;
  double low = from;
  double high = to;
  double s = from + (to - from) * miss_from / (miss_from - miss_to);
  if (rate_ == 0) return s;
  // Newton's method between two ends that are halved where it would leave them.
  constexpr int kMostIterations = 60;
  for (int i = 0; i < kMostIterations && high - low > tolerance; ++i) {
    const double bent_here = bent(s);
    const double miss = sign * (offset_ + slope_ * s + bent_here - level);
    (miss < 0 ? low : high) = s;
    const double step = -miss / (sign * (slope_ - rate_ * bent_here));
    const double next = s + step;
    if (next >= low && next <= high) {
      s = next;
      if (std::abs(step) <= tolerance) break;
    } else {
      s = 0.5 * (low + high);
    }
  }
  return s;
}

}  // namespace nightjar::sim
