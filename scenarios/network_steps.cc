#include "scenarios/network_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nightjar::scenarios {

NetworkSteps::NetworkSteps(core::Time begin, core::Time end, double rate_hz)
    : begin_(begin),
      end_(end),
      steps_(std::max(std::round(core::seconds(end - begin) * rate_hz), 1.0)) {
  assert(begin <= end && rate_hz > 0);
}

core::Time NetworkSteps::step_end(core::Time t) const {
  if (end_ <= begin_) return end_;
  const double share = core::seconds(t - begin_) / core::seconds(end_ - begin_);
  const double step = std::clamp(std::floor(share * steps_), 1.0, steps_);
  // Ends are whole microseconds, so the step's may have been rounded up to `t` or beyond.
  return end_of(step) >= t ? end_of(step) : end_of(step + 1);
}

core::Time NetworkSteps::end_of(double step) const {
  if (step >= steps_) return end_;
  return begin_ + core::from_seconds(core::seconds(end_ - begin_) * step / steps_);
}

}  // namespace nightjar::scenarios
