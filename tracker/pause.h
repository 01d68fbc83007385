#pragma once

#include <chrono>

#include "core/event.h"

namespace nightjar::tracker {

/// Longer without a step than any source's packets are: pictures stopped, somebody else flew.
/// Nothing goes on over more than this as if it had been seen.
inline constexpr core::Time kPause = std::chrono::milliseconds(150);

}  // namespace nightjar::tracker
