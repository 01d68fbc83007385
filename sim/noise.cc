#include "sim/noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nightjar::sim {
namespace {

constexpr double kLeastThreshold = 0.01;  // v2e emulator.py, cac6384

}  // namespace

PointProcess::PointProcess(std::span<const double> rates_hz, core::Random random)
    : columns_(rates_hz.size()), random_(random) {
  const double total_hz = std::accumulate(rates_hz.begin(), rates_hz.end(), 0.0);
  if (!(total_hz > 0)) return;
  mean_gap_us_ = 1e6 / total_hz;

  // Vose's construction: each column below the mean is filled up by one above it.
  std::vector<double> height(rates_hz.begin(), rates_hz.end());
  const double mean_hz = total_hz / static_cast<double>(height.size());
  std::vector<std::uint32_t> below, above;
  for (std::uint32_t i = 0; i < height.size(); ++i) {
    height[i] /= mean_hz;
    columns_[i] = {UINT32_MAX, i};
    (height[i] < 1 ? below : above).push_back(i);
  }
  while (!below.empty() && !above.empty()) {
    const std::uint32_t low = below.back();
    const std::uint32_t high = above.back();
    below.pop_back();
    columns_[low] = {static_cast<std::uint32_t>(height[low] * 0x1p32), high};
    height[high] -= 1 - height[low];
    if (height[high] >= 1) continue;
    above.pop_back();
    below.push_back(high);
  }
}

void PointProcess::start(core::Time t) {
  next_us_ = static_cast<double>(t.count());
  if (mean_gap_us_ > 0) next_us_ += gap_us();
}

void PointProcess::draw(core::Time until, std::vector<NoisePoint>& points) {
  if (!(mean_gap_us_ > 0)) return;
  const double until_us = static_cast<double>(until.count());
  while (next_us_ <= until_us) {
    const std::uint32_t from = source();
    const float mark = static_cast<float>(random_() >> 40) * 0x1p-24f;
    points.push_back({next_us_, from, mark});
    next_us_ += gap_us();
  }
}

double PointProcess::gap_us() { return mean_gap_us_ * core::exponential(random_); }

std::uint32_t PointProcess::source() {
  const std::uint64_t bits = random_();
  const auto i = static_cast<std::uint32_t>(((bits >> 32) * columns_.size()) >> 32);
  const Column& column = columns_[i];
  return static_cast<std::uint32_t>(bits) <= column.share ? i : column.alias;
}

std::vector<double> shot_noise_rates_hz(double shot_noise_rate_hz, double threshold_log,
                                        std::span<const float> thresholds_log) {
  std::vector<double> rates_hz;
  rates_hz.reserve(thresholds_log.size());
  for (const float own_log : thresholds_log)
    rates_hz.push_back(shot_noise_rate_hz / 2 * threshold_log / own_log);
  return rates_hz;
}

double shot_noise_factor(double intensity) {
  constexpr double kInWhite = 0.25;
  return 1 - (1 - kInWhite) * std::min(1.0, (intensity + 20) / 275);
}

HotPixels draw_hot_pixels(const PixelConfig& config, std::uint32_t pixels, std::uint64_t seed) {
  core::Random choice = core::random_stream(seed, "hot_pixel");
  core::Random rate = core::random_stream(seed, "hot_pixel_rate");
  HotPixels hot;
  for (std::uint32_t p = 0; p < pixels; ++p) {
    const double deviation = core::normal(rate);
    if (core::uniform01(choice) >= config.hot_pixel_fraction) continue;
    hot.pixels.push_back(p);
    hot.rates_hz.push_back(config.hot_pixel_rate_median_hz *
                           std::exp(config.hot_pixel_rate_sigma_ln * deviation));
  }
  return hot;
}

std::vector<float> draw_thresholds_log(double mean_log, double sigma_log, std::size_t pixels,
                                       core::Random random) {
  std::vector<float> thresholds(pixels);
  for (float& threshold : thresholds)
    threshold =
        static_cast<float>(std::max(kLeastThreshold, mean_log + sigma_log * core::normal(random)));
  return thresholds;
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

}  // namespace nightjar::sim
