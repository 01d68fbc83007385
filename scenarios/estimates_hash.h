#pragma once

#include <memory>
#include <string>

#include "core/state.h"

namespace nightjar::scenarios {

/// SHA-256 over the exact bits of a run's estimates, in order: equal for equal
/// bits only, whatever text would round away.
class EstimatesHash {
 public:
  EstimatesHash();
  ~EstimatesHash();
  EstimatesHash(EstimatesHash&&) noexcept;
  EstimatesHash& operator=(EstimatesHash&&) noexcept;

  /// Each number enters as eight bytes, least significant first: t and last_tag
  /// as whole microseconds, valid as 0 or 1, the rest as doubles, in the order
  /// of core::TargetEstimate.
  void add(const core::TargetEstimate& estimate);

  /// 64 lower-case hexadecimal digits for the estimates so far.
  std::string hex() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::scenarios
