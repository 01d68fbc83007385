#pragma once

#include "core/event.h"

namespace nightjar::scenarios {

/// When a recurrent network takes its steps between two times at which its picture is wanted:
/// at equal distances, as near to 1/rate_hz as whole numbers allow, the last at the later
/// time. A picture asked for between steps of their own would be one step more, made of
/// fewer events, and all later pictures would differ for it.
class NetworkSteps {
 public:
  /// Steps over (begin, end], at least one; `begin` <= `end`, `rate_hz` over 0, to 100000.
  NetworkSteps(core::Time begin, core::Time end, double rate_hz);

  /// When the step ends that an event at `t` belongs to: the first end not before `t`. The
  /// first step takes events at `begin`, too.
  core::Time step_end(core::Time t) const;

 private:
  core::Time end_of(double step) const;

  core::Time begin_, end_;
  double steps_;
};

}  // namespace nightjar::scenarios
