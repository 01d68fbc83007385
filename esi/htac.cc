#include "esi/htac.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "esi/fast_math.h"

namespace nightjar::esi {
namespace {

/// Powers of 2 that the unit may grow by: far from the range of floats, and so many that
/// moving the epoch, a pass over all pixels, is rare.
constexpr double kMostGrowth = 32;

std::array<float, 9> kernel(double contrast_log, double sigma_px) {
  // exp(-d^2 / 2 sigma^2) at a distance of 1.
  const double beside = sigma_px > 0 ? std::exp(-0.5 / (sigma_px * sigma_px)) : 0.0;
  const double side[] = {beside, 1, beside};
  const double sum = 1 + 2 * beside;
  std::array<float, 9> weights{};
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = static_cast<float>(contrast_log * side[i / 3] * side[i % 3] / (sum * sum));
  return weights;
}

}  // namespace

Htac::Htac(const HtacConfig& config, core::Resolution size)
    : Reconstructor(size), config_(config), kernel_(kernel(config.contrast_log, config.sigma_px)) {
  core::check_config(config, "htac");
  const double log2_per_us = std::numbers::log2e * 1e-6 / config.decay_time_s;
  log2_per_us_ = static_cast<float>(log2_per_us);
  most_us_ = static_cast<std::uint32_t>(
      std::min(kMostGrowth / log2_per_us, static_cast<double>(kMostAge_us)));
  const auto width = static_cast<std::uint32_t>(size.width_px);
  stride_ = width + 2;
  // Exact for pixels below 2^30 (Granlund and Montgomery, PLDI 1994, theorem 4.2).
  shift_ = 30 + std::bit_width(width - 1);
  reciprocal_ = ((std::uint64_t{1} << shift_) + width - 1) / width;
  reset();
}

void Htac::clear(core::Time start) {
  const auto rows = static_cast<std::size_t>(size().height_px) + 2;
  cells_.assign(rows * stride_, 0.0f);
  epoch_us_ = low_us(start);
}

void Htac::move_epoch(std::uint32_t to_us) {
  const float left = fast_exp2(-log2_per_us_ * static_cast<float>(to_us - epoch_us_));
  constexpr float kNothing = 1e-20f;  // far from denormals, which are slow
  for (float& cell : cells_) {
    const float decayed = cell * left;
    cell = select(std::abs(decayed) > kNothing, decayed, 0.0f);
  }
  epoch_us_ = to_us;
}

void Htac::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  move_epoch(low_us(last()));
  if (most_us == 0) epoch_us_ = now_us;
}

/// Where the kernel's first weight goes for an event at `pixel`.
inline std::uint32_t Htac::index(std::uint32_t pixel) const {
  const auto y = static_cast<std::uint32_t>(pixel * reciprocal_ >> shift_);
  return pixel + 2 * y;
}

void Htac::integrate(std::span<const PackedEvent> events) {
  const auto least = static_cast<float>(config_.least_log);
  const auto greatest = static_cast<float>(config_.greatest_log);
  const std::size_t stride = stride_;
  const std::array<float, 9> kernel = kernel_;
  for (const PackedEvent& e : events) {
    if (e.t_us - epoch_us_ > most_us_) move_epoch(e.t_us);
    const float unit = fast_exp2(log2_per_us_ * static_cast<float>(e.t_us - epoch_us_));
    const float signed_unit = e.on() ? unit : -unit;
    const float low = least * unit;
    const float high = greatest * unit;
    float* row = cells_.data() + index(e.pixel());
    for (std::size_t dy = 0; dy < 3; ++dy, row += stride)
      for (std::size_t dx = 0; dx < 3; ++dx)
        row[dx] = std::clamp(row[dx] + kernel[3 * dy + dx] * signed_unit, low, high);
  }
}

void Htac::draw(core::Time t, core::Image<std::uint8_t>& gray) {
  const auto least = static_cast<float>(config_.least_log);
  const float per_level = 255.0f / static_cast<float>(config_.greatest_log - config_.least_log);
  const float left = fast_exp2(-log2_per_us_ * static_cast<float>(low_us(t) - epoch_us_));
  for (int y = 0; y < size().height_px; ++y) {
    const float* row = cells_.data() + static_cast<std::size_t>(y + 1) * stride_ + 1;
    std::uint8_t* out = &gray(0, y);
#pragma GCC ivdep
    for (int x = 0; x < size().width_px; ++x) out[x] = to_gray((row[x] * left - least) * per_level);
  }
}

}  // namespace nightjar::esi
