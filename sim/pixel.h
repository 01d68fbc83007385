#pragma once

#include "sim/pixel_math.h"

namespace nightjar::sim {

/// A pixel's residual (photoreceptor output minus what it last memorised) over one
/// step, in closed form: s runs from 0 to 1, the log intensity moves linearly.
///     residual(s) = offset + slope s + bend exp(-rate s)
struct ResidualCourse {
  double offset = 0;
  double slope = 0;
  double bend = 0;
  double rate = 0;         ///< The photoreceptor's rate constant times the step.
  double bent_at_end = 0;  ///< bend exp(-rate): residual(1) is asked for most.
  double leak = 0;         ///< What part of `slope` is leak.

  /// `change` of the log intensity and `leak` over the whole step; `lag` of the
  /// photoreceptor (output minus log intensity) and `residual` at s = 0; `rate` is 0
  /// where there is no low pass.
  [[gnu::always_inline]] static inline ResidualCourse over_step(double change, double leak,
                                                                double lag, double residual,
                                                                double rate) {
    // d lag/ds = -rate lag - change, so lag(s) = bend exp(-rate s) - change/rate.
    const double bend = select(rate > 0, lag + change / rate, 0.0);
    return {residual - bend, change + leak, bend, rate, bend * fast_exp_minus(rate), leak};
  }

  double residual(double s) const { return offset + slope * s + bend * fast_exp_minus(rate * s); }
  double residual_at_end() const { return offset + slope + bent_at_end; }

  /// The pixel memorises its output of the moment when its residual was `level`.
  void memorise(double level) { offset -= level; }

  /// The leak over a whole step becomes `new_leak` from `s` on.
  void change_leak(double s, double new_leak) {
    offset -= (new_leak - leak) * s;
    slope += new_leak - leak;
    leak = new_leak;
  }
};

}  // namespace nightjar::sim
