#include "sim/leak.h"

#include <cmath>

#include "core/random.h"

namespace nightjar::sim {

Leak::Leak(const PixelConfig& config, std::span<const float> thresholds_on_log, std::uint64_t seed)
    : jitter_(config.leak_jitter), key_(core::random_stream(seed, "leak_jitter")()) {
  if (config.leak_rate_hz <= 0) return;
  core::Random spread = core::random_stream(seed, "leak_spread");
  pixels_.reserve(thresholds_on_log.size());
  for (const float threshold_log : thresholds_on_log) {
    const double rate_hz =
        config.leak_rate_hz * std::pow(10.0, config.leak_spread_decades * core::normal(spread));
    pixels_.push_back({static_cast<float>(rate_hz * threshold_log), 0});
  }
}

std::vector<float> draw_leak_phases_log(std::span<const float> thresholds_on_log,
                                        std::uint64_t seed) {
  core::Random phase = core::random_stream(seed, "leak_phase");
  std::vector<float> phases_log;
  phases_log.reserve(thresholds_on_log.size());
  for (const float threshold_log : thresholds_on_log)
    phases_log.push_back(static_cast<float>(core::uniform01(phase) * threshold_log));
  return phases_log;
}

}  // namespace nightjar::sim
