#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/event.h"

namespace nightjar::scenarios {

/// Latencies counted in classes 2 % apart, so that their memory never grows.
class LatencyHistogram {
 public:
  /// Less than nothing counts as nothing.
  void add(core::Time latency);

  std::uint64_t count() const { return count_; }
  core::Time greatest() const { return greatest_; }

  /// What `share` of all stay within, 0 to 1, at most 2 % or 1 us too long; 0 of none.
  core::Time quantile(double share) const;

 private:
  static std::size_t class_of(core::Time latency);

  static constexpr std::size_t kClasses = 2300;  // 1.02^2300 us is beyond 64 bits
  std::array<std::uint64_t, kClasses> counts_{};
  std::uint64_t count_ = 0;
  core::Time greatest_{};
};

}  // namespace nightjar::scenarios
