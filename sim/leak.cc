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

double leak_deviation(std::uint64_t key, std::uint32_t pixel, std::uint32_t n) {
  // SplitMix64's finaliser over the counter; four 16-bit uniforms added up have the
  // mean 4 * 32767.5 and the variance 4 * 65536^2 / 12.
  std::uint64_t z = key + ((static_cast<std::uint64_t>(pixel) << 32) | n) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  const std::uint64_t sum = (z & 0xffff) + ((z >> 16) & 0xffff) + ((z >> 32) & 0xffff) + (z >> 48);
  return (static_cast<double>(sum) - 4 * 32767.5) / (65536 * 0.57735026918962576);
}

float Leak::next_per_s(std::uint32_t pixel) {
  Pixel& leak = pixels_[pixel];
  const double deviation = leak_deviation(key_, pixel, leak.draws++);
  return static_cast<float>(leak.mean_per_s / (1 + jitter_ * deviation));
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
