#pragma once

#include "core/config_check.h"

namespace nightjar::esi {

enum class AccumulatorDecay { none, exponential, linear, step };

inline constexpr core::Choices<AccumulatorDecay, 4> kAccumulatorDecays{
    {{"none", AccumulatorDecay::none},
     {"exponential", AccumulatorDecay::exponential},
     {"linear", AccumulatorDecay::linear},
     {"step", AccumulatorDecay::step}}};

/// iniVation's Accumulator, with the defaults of dv-processing 1.x.
struct AccumulatorConfig {
  double contribution = 0.15;  ///< Added or taken away by an event.
  double least = 0.0;          ///< Black.
  double greatest = 1.0;       ///< White.
  double neutral = 0.0;        ///< Where a pixel starts and what it decays to.
  AccumulatorDecay decay = AccumulatorDecay::exponential;
  double decay_time_s = 1.0;       ///< Exponential: to 1/e.
  double decay_per_s = 1.0;        ///< Linear: towards neutral.
  bool synchronous_decay = false;  ///< All pixels at the picture instead of each at its events.
  bool ignore_polarity = false;    ///< Every event counts as ON.

  template <class Visitor>
  void visit(Visitor& v) {
    const core::Origin dv{"dv-processing 1.x Accumulator", core::kPureNumber};
    v.field("contribution", contribution, 0.0001, 1.0, dv);
    v.field("least", least, -10.0, 10.0, dv);
    v.field("greatest", greatest, -10.0, 10.0, dv);
    v.field("neutral", neutral, -10.0, 10.0, dv);
    v.choice("decay", decay, kAccumulatorDecays);
    v.field("decay_time_s", decay_time_s, 0.0001, 1000.0);
    v.field("decay_per_s", decay_per_s, 0.0, 10000.0);
    v.field("synchronous_decay", synchronous_decay);
    v.field("ignore_polarity", ignore_polarity);
  }
};

}  // namespace nightjar::esi
