#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "esi/esi_config.h"
#include "esi/packed_event.h"

namespace nightjar::esi {

/// Algorithm 2 of the ESI paper as it is printed, in doubles and std::pow, with the
/// options of EsiConfig: what Esi is checked against, and how much faster it is than this.
/// Takes neither checks nor times before the start or 71 minutes after it.
class EsiReference {
 public:
  EsiReference(const EsiConfig& config, core::Resolution size)
      : config_(config),
        size_(size),
        sum_log_(static_cast<std::size_t>(size.pixels())),
        last_s_(static_cast<std::size_t>(size.pixels())) {}

  void process(std::span<const PackedEvent> events) {
    for (const PackedEvent& e : events) {
      double& sum = sum_log_[e.pixel()];
      const double t_s = 1e-6 * e.t_us;
      const double step = e.on() ? config_.contrast_log : -config_.contrast_log;
      const double left = decay(t_s - last_s_[e.pixel()]);
      sum = config_.order == EsiOrder::add_then_decay ? (sum + step) * left : sum * left + step;
      last_s_[e.pixel()] = t_s;
      sum = std::min(std::max(sum, config_.least_log), config_.greatest_log);
    }
  }

  core::Image<std::uint8_t> picture(core::Time t) const {
    core::Image<std::uint8_t> gray(size_);
    for (std::size_t i = 0; i < sum_log_.size(); ++i) {
      const double left = config_.decay_at_picture ? decay(core::seconds(t) - last_s_[i]) : 1.0;
      const double share =
          (sum_log_[i] * left - config_.least_log) / (config_.greatest_log - config_.least_log);
      gray.pixels()[i] = static_cast<std::uint8_t>(std::lround(255.0 * share));  // eq. 14
    }
    return gray;
  }

  double sum_log(std::size_t pixel) const { return sum_log_[pixel]; }

 private:
  /// Eq. 4; below 0 the power would be no number.
  double decay(double dt_s) const {
    return std::pow(std::max(1.0 - config_.decay_rate_hz * dt_s, 0.0), config_.decay_power);
  }

  EsiConfig config_;
  core::Resolution size_;
  std::vector<double> sum_log_;  ///< S
  std::vector<double> last_s_;   ///< T
};

}  // namespace nightjar::esi
