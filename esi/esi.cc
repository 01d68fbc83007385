#include "esi/esi.h"

namespace nightjar::esi {
namespace {

LeakySum leaky_sum(const EsiConfig& config) {
  core::check_config(config, "esi");
  LeakySum sum(Leak::power, config.decay_rate_hz, config.decay_power);
  const auto step = static_cast<float>(config.contrast_log);
  sum.step = {-step, step};
  sum.least = static_cast<float>(config.least_log);
  sum.greatest = static_cast<float>(config.greatest_log);
  sum.leak_first = config.order == EsiOrder::decay_then_add;
  return sum;
}

}  // namespace

Esi::Esi(const EsiConfig& config, core::Resolution size)
    : Reconstructor(size), sum_(leaky_sum(config)), decay_at_picture_(config.decay_at_picture) {
  reset();
}

void Esi::clear(core::Time start) {
  cells_.assign(static_cast<std::size_t>(size().pixels()), SumCell{0, low_us(start)});
}

void Esi::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  limit_times(cells_, now_us, most_us);
}

void Esi::integrate(std::span<const PackedEvent> events) {
  EventRun run(events);
  integrate_run(run);
}

void Esi::integrate_run(EventRun& run) {
  best_leaky_sum_variant().integrate(sum_, run, cells_.data());
}

void Esi::draw(core::Time t, core::Image<std::uint8_t>& gray) {
  best_leaky_sum_variant().draw(sum_, decay_at_picture_, low_us(t), cells_, gray.pixels().data());
}

}  // namespace nightjar::esi
