#pragma once

namespace nightjar::sim {

/// A pixel's residual (photoreceptor output minus what it last memorised) over one
/// step, in closed form: s runs from 0 to 1, the log intensity moves linearly.
///     residual(s) = offset + slope s + bend exp(-rate s)
class ResidualCourse {
 public:
  /// `change` of the log intensity and `leak` over the whole step; `lag` of the
  /// photoreceptor (output minus log intensity) and `residual` at s = 0; `rate` is the
  /// photoreceptor's rate constant times the step, 0 where it has no low pass.
  ResidualCourse(double change, double leak, double lag, double residual, double rate);

  double residual(double s) const { return offset_ + slope_ * s + bent(s); }

  /// The pixel memorises its output of the moment when its residual was `level`.
  void memorise(double level) { offset_ -= level; }

  /// The leak over a whole step becomes `leak` from `s` on.
  void change_leak(double s, double leak);

  /// First s in [from, to] with residual(s) = level, to `tolerance`, if residual(to)
  /// has reached the level (is beyond 0 by at least as much). There is just one
  /// passage, since the residual has at most one extremum. A level passed before
  /// `from` gives `from`.
  double crossing(double from, double to, double level, double tolerance) const;

 private:
  double bent(double s) const;

  double offset_;
  double slope_;
  double bend_;
  double rate_;
  double leak_;
  double bent_at_end_;  ///< bent(1), asked for most.
};

}  // namespace nightjar::sim
