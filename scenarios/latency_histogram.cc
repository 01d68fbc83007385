#include "scenarios/latency_histogram.h"

#include <algorithm>
#include <cmath>

namespace nightjar::scenarios {
namespace {

constexpr double kRatio = 1.02;

}  // namespace

/// Class 0 is up to 0, class i + 1 up to kRatio^i us.
std::size_t LatencyHistogram::class_of(core::Time latency) {
  if (latency <= core::Time(0)) return 0;
  const double i = std::ceil(std::log(static_cast<double>(latency.count())) / std::log(kRatio));
  return 1 + static_cast<std::size_t>(i);
}

void LatencyHistogram::add(core::Time latency) {
  ++counts_[class_of(latency)];
  ++count_;
  greatest_ = std::max(greatest_, latency);
}

core::Time LatencyHistogram::quantile(double share) const {
  const double wanted = share * static_cast<double>(count_);
  std::uint64_t within = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    within += counts_[i];
    if (within == 0 || static_cast<double>(within) < wanted) continue;
    if (i == 0) return core::Time(0);
    const double upper_us = std::ceil(std::pow(kRatio, static_cast<double>(i - 1)));
    return upper_us < static_cast<double>(greatest_.count())
               ? core::Time(static_cast<std::int64_t>(upper_us))
               : greatest_;
  }
  return core::Time(0);
}

}  // namespace nightjar::scenarios
