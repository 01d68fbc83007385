#pragma once

#include <optional>

namespace nightjar::camera {

// libcaer's numbers of special events.
inline constexpr int kTimestampWrap = 0;
inline constexpr int kTimestampReset = 1;
inline constexpr int kExternalRising = 2;
inline constexpr int kExternalFalling = 3;
inline constexpr int kExternalPulse = 4;

/// libcaer's number for AEDAT4's number of a trigger, and the reverse; nothing where the
/// other side has none.
std::optional<int> trigger_from_aedat4(int type);
std::optional<int> trigger_to_aedat4(int type);

}  // namespace nightjar::camera
