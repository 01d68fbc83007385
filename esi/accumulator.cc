#include "esi/accumulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace nightjar::esi {
namespace {

void check(const AccumulatorConfig& config) {
  core::check_config(config, "accumulator");
  if (config.least >= config.greatest)
    throw std::invalid_argument("accumulator.least = " + core::number_text(config.least) +
                                ", allowed below greatest = " + core::number_text(config.greatest));
  core::check_range("accumulator.neutral", config.neutral, config.least, config.greatest);
}

LeakySum decay_of(const AccumulatorConfig& config) {
  if (!config.synchronous_decay && config.decay == AccumulatorDecay::exponential)
    return {Leak::exponential, std::numbers::log2e / config.decay_time_s};
  if (!config.synchronous_decay && config.decay == AccumulatorDecay::linear)
    return {Leak::slope, config.decay_per_s};
  return {Leak::linear, 0};
}

LeakySum leaky_sum(const AccumulatorConfig& config) {
  check(config);
  LeakySum sum = decay_of(config);
  const auto step = static_cast<float>(config.contribution);
  sum.step = {config.ignore_polarity ? step : -step, step};
  sum.least = static_cast<float>(config.least - config.neutral);
  sum.greatest = static_cast<float>(config.greatest - config.neutral);
  sum.leak_first = true;
  return sum;
}

}  // namespace

Accumulator::Accumulator(const AccumulatorConfig& config, core::Resolution size)
    : Reconstructor(size), config_(config), sum_(leaky_sum(config)) {
  reset();
}

void Accumulator::clear(core::Time start) {
  cells_.assign(static_cast<std::size_t>(size().pixels()), SumCell{0, low_us(start)});
  decayed_to_ = start;
  drawn_ = false;
}

void Accumulator::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  limit_times(cells_, now_us, most_us);
}

void Accumulator::integrate(std::span<const PackedEvent> events) {
  EventRun run(events);
  integrate_run(run);
}

void Accumulator::integrate_run(EventRun& run) {
  if (run.rest().empty()) return;
  if (drawn_ && config_.decay == AccumulatorDecay::step)
    for (SumCell& cell : cells_) cell.sum = 0;
  drawn_ = false;
  best_leaky_sum_variant().integrate(sum_, run, cells_.data());
}

void Accumulator::draw(core::Time t, core::Image<std::uint8_t>& gray) {
  drawn_ = true;
  if (config_.synchronous_decay) decay_all(t);
  best_leaky_sum_variant().draw(sum_, true, low_us(t), cells_, gray.pixels().data());
}

void Accumulator::decay_all(core::Time t) {
  if (t <= decayed_to_) return;
  const double dt_s = core::seconds(t - decayed_to_);
  decayed_to_ = t;
  if (config_.decay == AccumulatorDecay::exponential) {
    const auto left = static_cast<float>(std::exp(-dt_s / config_.decay_time_s));
    constexpr float kNothing = 1e-20f;  // far from denormals, which are slow
    for (SumCell& cell : cells_)
      cell.sum = std::abs(cell.sum * left) > kNothing ? cell.sum * left : 0.0f;
  } else if (config_.decay == AccumulatorDecay::linear) {
    const auto most = static_cast<float>(dt_s * config_.decay_per_s);
    for (SumCell& cell : cells_) cell.sum -= std::clamp(cell.sum, -most, most);
  }
}

}  // namespace nightjar::esi
