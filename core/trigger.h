#pragma once

namespace nightjar::core {

/// The greatest number of a trigger's type that any part of the project takes: seven bits in
/// AEDAT 3.1.
inline constexpr int kMostTriggerType = 127;

}  // namespace nightjar::core
