#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "esi/accumulator_config.h"

namespace nightjar::test {

/// The accumulator in doubles, one pixel at a time, straight from its description.
class PlainAccumulator {
 public:
  PlainAccumulator(const esi::AccumulatorConfig& config, core::Resolution size)
      : config_(config),
        size_(size),
        potential_(static_cast<std::size_t>(size.pixels()), config.neutral),
        last_s_(potential_.size()) {}

  void process(const core::Event& e) {
    if (drawn_ && config_.decay == esi::AccumulatorDecay::step)
      potential_.assign(potential_.size(), config_.neutral);
    drawn_ = false;
    const auto i = static_cast<std::size_t>(e.y * size_.width_px + e.x);
    const double t_s = core::seconds(e.t);
    if (!config_.synchronous_decay) potential_[i] = decayed(potential_[i], t_s - last_s_[i]);
    last_s_[i] = t_s;
    potential_[i] += e.on || config_.ignore_polarity ? config_.contribution : -config_.contribution;
    potential_[i] = std::clamp(potential_[i], config_.least, config_.greatest);
  }

  core::Image<std::uint8_t> picture(core::Time t) {
    drawn_ = true;
    const double t_s = core::seconds(t);
    core::Image<std::uint8_t> gray(size_);
    for (std::size_t i = 0; i < potential_.size(); ++i) {
      double shown = decayed(potential_[i], t_s - last_s_[i]);
      if (config_.synchronous_decay)
        shown = potential_[i] = decayed(potential_[i], std::max(t_s - pictured_s_, 0.0));
      gray.pixels()[i] = static_cast<std::uint8_t>(
          std::lround(255 * (shown - config_.least) / (config_.greatest - config_.least)));
    }
    pictured_s_ = std::max(pictured_s_, t_s);
    return gray;
  }

 private:
  double decayed(double potential, double dt_s) const {
    const double above = potential - config_.neutral;
    switch (config_.decay) {
      case esi::AccumulatorDecay::exponential:
        return config_.neutral + above * std::exp(-dt_s / config_.decay_time_s);
      case esi::AccumulatorDecay::linear: {
        const double most = config_.decay_per_s * dt_s;
        return config_.neutral +
               (above > 0 ? std::max(above - most, 0.0) : std::min(above + most, 0.0));
      }
      default: return potential;
    }
  }

  esi::AccumulatorConfig config_;
  core::Resolution size_;
  std::vector<double> potential_;
  std::vector<double> last_s_;
  double pictured_s_ = 0;
  bool drawn_ = false;
};

}  // namespace nightjar::test
