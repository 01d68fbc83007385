#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/sensor_config.h"

namespace nightjar::sim {

/// Relative deviation of one leak interval, close to Gaussian with deviation 1 and
/// within +-3.47. A function of its arguments alone: the n-th draw of a pixel is the
/// same whatever the other pixels do.
inline double leak_deviation(std::uint64_t key, std::uint32_t pixel, std::uint32_t n) {
  // SplitMix64's finaliser over the counter; four 16-bit uniforms added up have the
  // mean 4 * 32767.5 and the variance 4 * 65536^2 / 12.
  std::uint64_t z = key + ((static_cast<std::uint64_t>(pixel) << 32) | n) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  const std::uint64_t sum = (z & 0xffff) + ((z >> 16) & 0xffff) + ((z >> 32) & 0xffff) + (z >> 48);
  return (static_cast<double>(sum) - 4 * 32767.5) / (65536 * 0.57735026918962576);
}

/// Each pixel's leak: a frozen spread from pixel to pixel, and a jitter with one draw an
/// interval between events. (v2e draws the jitter for each frame, which the number of
/// frames averages out.)
class Leak {
 public:
  /// `thresholds_on_log` of all pixels: what a pixel's rate in Hz is measured in.
  Leak(const PixelConfig& config, std::span<const float> thresholds_on_log, std::uint64_t seed);

  /// False if no pixel leaks; the functions below are for those that do.
  bool enabled() const { return !pixels_.empty(); }
  /// Without jitter, log intensity a second.
  float mean_per_s(std::uint32_t pixel) const { return pixels_[pixel].mean_per_s; }
  /// `next_per_s` will be asked for this pixel.
  void prefetch(std::uint32_t pixel) const {
    if (enabled()) __builtin_prefetch(&pixels_[pixel], 1);
  }
  /// That of the pixel's next interval.
  float next_per_s(std::uint32_t pixel) {
    Pixel& leak = pixels_[pixel];
    const double deviation = leak_deviation(key_, pixel, leak.draws++);
    return static_cast<float>(leak.mean_per_s / (1 + jitter_ * deviation));
  }

 private:
  struct Pixel {
    float mean_per_s;
    std::uint32_t draws;
  };
  std::vector<Pixel> pixels_;
  double jitter_;
  std::uint64_t key_;
};

/// How far each pixel has leaked at the start, from 0 to its threshold: else all would
/// fire at once.
std::vector<float> draw_leak_phases_log(std::span<const float> thresholds_on_log,
                                        std::uint64_t seed);

}  // namespace nightjar::sim
