#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "esi/event_run.h"

namespace nightjar::esi {

/// A pixel's sum and the time up to which it has leaked, side by side since every event
/// touches both.
struct SumCell {
  float sum = 0;
  std::uint32_t t_us = 0;
};

/// How a sum goes back to 0 with the time dt since the pixel's last event.
enum class Leak {
  linear,        ///< times max(1 - k dt, 0)
  power,         ///< times max(1 - k dt, 0)^b; for b < 1, beyond which there is
  smooth_power,  ///< the same for b > 1, where one polynomial will do
  exponential,   ///< times 2^(-k dt)
  slope,         ///< by k dt, as far as 0
};

/// What the events do to a pixel: ESI and the accumulator in one. A factor d is kept as what
/// is lost, 1 - d: near d = 1, where most events are, a float holds it far more finely, and
/// it is exactly 0 at dt = 0.
struct LeakySum {
  /// `rate_hz` is k, `power` is b, at most 32, and matters to Leak::power alone, which becomes
  /// linear or smooth_power where k and b allow.
  LeakySum(Leak leak, double rate_hz, double power = 1);

  Leak leak;
  bool leak_first = false;      ///< Else an event is added first, and leaks with the rest.
  std::array<float, 2> step{};  ///< Added by an OFF and by an ON event.
  float least = 0;              ///< At most 0.
  float greatest = 0;           ///< At least 0, above `least`.

  /// k; for b > 8 it is k b/8: nothing is left from dt = 8/(k b) on, where the power would be
  /// (1 - 8/b)^b, below 1.1e-4. Of linear and of powers nothing is left where this times dt is 1
  /// or more; rounded so that for b <= 8 that is so from dt = 1/k on.
  float rate_per_us;
  std::array<float, 8> power_terms{};     ///< Of the polynomial, in rising powers; power: five.
  std::array<float, 5> octave_factors{};  ///< Power: 2^(-b 2^i).
  /// Power: 2^(-b i), as the product of those, by the last bits of the exponent of a float
  /// from 2^-(i + 1) to 2^-i. For 1 itself 1, for 0 none.
  std::array<float, 32> octaves{};
};

/// What is done to cells, for one instruction set.
struct LeakySumVariant {
  const char* name;
  /// Takes events to the run's end. A time between a pixel's events is below 2^31 us.
  void (*integrate)(const LeakySum&, EventRun&, SumCell* cells);
  /// [least, greatest] as 0 to 255, rounded; leaked up to `now_us` for `leak`, where a time
  /// from 2^31 us on counts as 2^31 - 1. Leaves the cells as they are.
  void (*draw)(const LeakySum&, bool leak, std::uint32_t now_us, std::span<const SumCell> cells,
               std::uint8_t* gray);
};

/// Those this processor can run, slowest first. All give the same bits; what is lost is
/// within 3e-5 of itself, for b < 0.25 within 5e-5, for b > 1 within 1.2e-3.
std::vector<LeakySumVariant> leaky_sum_variants();

/// The last of them.
const LeakySumVariant& best_leaky_sum_variant();

}  // namespace nightjar::esi
